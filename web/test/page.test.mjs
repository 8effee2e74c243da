// The page in a browser: its three parts clicked through, small, for here the GPU is a CPU; nothing of ours on the console.
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { get } from 'node:http';
import { join } from 'node:path';
import { test } from 'node:test';
import { serve } from '../page/serve.mjs';
import { perSecond } from '../page/ui/elements.js';
import { withAddress } from './browser/chromium.mjs';

const pictures = `${import.meta.dirname}/../../build/web/screenshots`;
mkdirSync(pictures, { recursive: true });

/** A GLB of so many cubes in a row, each a mesh of its own, the first of them eight times over where
 * that is `instanced`; `without` of what it says of itself. */
function glb(cubes, without = [], instanced = false) {
  const corners = Array.from({ length: 8 }, (_, i) => [i & 1, (i >> 1) & 1, (i >> 2) & 1]).flat();
  const indices = [0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5];
  const bytes = Buffer.concat([Buffer.from(Float32Array.from(corners).buffer), Buffer.from(Uint16Array.from(indices).buffer)]);
  const scene = {
    asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [...Array(cubes).keys()] }],
    nodes: Array.from({ length: cubes }, (_, i) => ({ mesh: 0, translation: [3 * (i % 10), 0, 3 * Math.floor(i / 10)] })),
    meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1 }] }],
    buffers: [{ byteLength: bytes.length }], bufferViews: [{ buffer: 0, byteLength: 96 }, { buffer: 0, byteOffset: 96, byteLength: 72 }],
    accessors: [{ bufferView: 0, componentType: 5126, count: 8, type: 'VEC3', min: [0, 0, 0], max: [1, 1, 1] },
      { bufferView: 1, componentType: 5123, count: 36, type: 'SCALAR' }] };
  for (const key of without) delete scene[key];
  if (instanced) {
    scene.nodes[0].extensions = { EXT_mesh_gpu_instancing: { attributes: { TRANSLATION: 0 } } }; // the corners
    scene.extensionsUsed = ['EXT_mesh_gpu_instancing'];
  }
  const text = Buffer.from(JSON.stringify(scene)), json = Buffer.concat([text, Buffer.alloc(-text.length & 3, ' ')]);
  const chunk = (data, kind) => Buffer.concat([Buffer.from(Uint32Array.of(data.length, kind).buffer), data]);
  const body = Buffer.concat([chunk(json, 0x4e4f534a), chunk(bytes, 0x004e4942)]);
  return Buffer.concat([Buffer.from(Uint32Array.of(0x46546c67, 2, 12 + body.length).buffer), body]);
}

const text = (page, at) => page.locator(at).innerText();

/** Opens the page, its measurements short, does with it, and holds the console to silence. */
async function onPage(does, options) {
  const { address, close } = await serve();
  try {
    await withAddress(`${address}?quick`, does, options);
  } finally {
    close();
  }
}

async function clickModels(page) {
  await page.waitForFunction(() => window.sightline.models.ready);
  for (const method of ['none', 'toca', 'boca', 'iwcpa', 'bvha', 'tuned-iwcpa', 'wide-rays', 'saa']) {
    await page.click(`#models .choice label:text-is("${method}")`);
    await page.waitForTimeout(60);
  }
  await page.click('#models label.toggle:has-text("kept and what is culled")');
  await page.click('#models label.toggle:has-text("recorded path")');
  await page.waitForTimeout(300);
  await page.click('#viewpoint');
  await page.focus('#models canvas.stage');
  await page.keyboard.down('w'), await page.waitForTimeout(200), await page.keyboard.up('w');
  await page.click('#models label.toggle:has-text("kept and what is culled")');
  await page.click('#viewpoint');
  await page.waitForFunction(() => window.sightline.models.rested);
  const rested = await page.evaluate(() => window.sightline.models.rested);
  assert.ok(rested.kept > 50 && rested.visible > 100 && rested.lostPixels < 0.7 * rested.objectPixels, JSON.stringify(rested));
}

// What the page measures, at the least it can be asked for: a minute, where the GPU is a CPU.
async function measure(page) {
  await page.click('#measure-path');
  await page.waitForFunction(() => window.sightline.models.evidence.data.path && !window.sightline.models.measuring);
  for (const [button, name] of [['#figure-12', 'figure12'], ['#table-6', 'table6'], ['#figure-13', 'figure13']]) {
    await page.click(button);
    await page.waitForFunction((key) => window.sightline.models.evidence.data[key] && !window.sightline.models.measuring &&
      !document.querySelector('#table-6').disabled, name);
  }
  const saved = page.waitForEvent('download');
  await page.click('#download');
  const report = JSON.parse(readFileSync(await (await saved).path(), 'utf8'));
  assert.deepEqual(report.table6.map(({ meshes }) => meshes), [1371, 2684, 4433, 6744, 17773]);
  for (const row of report.table6) {
    assert.equal(Object.keys(row.times).length, 7);
    assert.ok(Object.values(row.times).every(({ ready_ms, first_ms }) => ready_ms >= 0 && first_ms >= 0)); // a clock may stand still
    assert.ok(Object.values(row.differing).every((rays) => rays === 0), JSON.stringify(row.differing));
    assert.ok(row.kept > 0 && row.lostPixels < row.objectPixels);
  }
  assert.equal(report.published[4].boca, 2591.6);
  assert.equal(report.figure13.length, 8);
  assert.ok(report.path.rows.length > 3 && report.figure12.kept > 0);
  assert.equal(await page.locator('#models .pictures canvas').count(), 2);
  assert.equal(await page.locator('#models .dome circle[fill]').count(), 8);
}

async function clickCity(page) {
  await page.click('#tab-city');
  await page.waitForFunction(() => window.sightline.city.made);
  for (const kind of ['one InstancedMesh', 'meshes of their own', 'one BatchedMesh']) {
    await page.click(`#city .choice label:text-is("${kind}")`);
    await page.waitForFunction(() => window.sightline.city.made);
    const modes = ['none', 'three’s own', 'Sightline', 'Sightline with occlusion'];
    for (const mode of process.env.SIGHTLINE_FULL || kind === 'one InstancedMesh' ? modes : modes.slice(3)) {
      await page.click(`#city .choice label:text-is("${mode}")`);
      await page.waitForTimeout(80);
    }
  }
  await page.click('#city label.toggle:has-text("show the depth")');
  await page.waitForFunction(() => window.sightline.city.stage.culler.readDepth()?.nearness.some((x) => x > 0));
  await page.click('#city label.toggle:has-text("freeze")');
  await page.waitForTimeout(200);
  await page.click('#city label.toggle:has-text("freeze")');
  await page.click('#city label.toggle:has-text("walk")');
  await page.click('#compare');
  await page.waitForSelector('#city table');
  const rows = await page.evaluate(() => window.sightline.city.compare());
  assert.ok(rows.occlusion.triangles < 0.8 * rows.none.triangles, JSON.stringify(rows));
}

async function clickDrop(page) {
  await page.click('#tab-drop');
  await page.waitForFunction(() => window.sightline.drop.made);
  await page.setInputFiles('#file', { name: 'row.glb', mimeType: 'model/gltf-binary', buffer: glb(200) });
  await page.waitForFunction(() => document.querySelector('#drop .hint').textContent.startsWith('row.glb: 200 meshes, 2,400 triangles'));
  await page.click('#gain');
  await page.waitForSelector('#drop table');
  await page.setInputFiles('#file', { name: 'eight.glb', mimeType: 'model/gltf-binary', buffer: glb(1, [], true) });
  await page.waitForFunction(() => document.querySelector('#drop .hint').textContent.startsWith('eight.glb: 8 meshes, 96 triangles'));
  await page.setInputFiles('#file', { name: 'none.glb', mimeType: 'model/gltf-binary', buffer: Buffer.from('no model, but some words') });
  await page.waitForSelector('#drop .said:not([hidden])');
  assert.match(await text(page, '#drop .said'), /^none\.glb cannot be shown: it is no binary glTF/);
  await page.setInputFiles('#file', { name: 'cut.glb', mimeType: 'model/gltf-binary', buffer: glb(3).subarray(0, 200) });
  await page.waitForFunction(() => document.querySelector('#drop .said').textContent.startsWith('cut.glb'));
  // A length that no file of this size has.
  const long = glb(3);
  long.writeUInt32LE(0x7fffffff, 12);
  await page.setInputFiles('#file', { name: 'long.glb', mimeType: 'model/gltf-binary', buffer: long });
  await page.waitForFunction(() => document.querySelector('#drop .said').textContent.startsWith('long.glb'));
  assert.match(await text(page, '#drop .said'), /^long\.glb cannot be shown: it is cut short or damaged \(.*[^.]\)\.$/);
  const bare = { name: 'bare.glb', mimeType: 'model/gltf-binary', buffer: glb(3, ['scene', 'scenes']) };
  await page.setInputFiles('#file', bare);
  await page.waitForFunction(() => document.querySelector('#drop .said').textContent.startsWith('bare.glb'));
  assert.equal(await text(page, '#drop .said'), 'bare.glb cannot be shown: the model has no scene.');
}

// By keys and by names alone.
async function goAbout(page) {
  const shown = () => page.getByRole('tabpanel').evaluateAll((all) => all.map(({ id }) => id));
  await page.focus('#tab-drop');
  for (const [key, part] of [['ArrowRight', 'models'], ['ArrowRight', 'city'], ['ArrowLeft', 'models'], ['End', 'drop'], ['Home', 'models']]) {
    await page.keyboard.press(key);
    await page.waitForFunction((id) => !document.getElementById(id).hidden && document.activeElement.id === `tab-${id}`, part);
    assert.deepEqual(await shown(), [part]);
  }
  assert.equal(await page.locator('[role=tab][tabindex="0"]').count(), 1);
  assert.equal(await page.getByRole('tabpanel', { name: 'Models' }).count(), 1);
  assert.equal(await page.getByRole('slider', { name: 'Rays along each side', exact: true }).count(), 1);
}

// As a driver takes it.
async function loseWebGL(page) {
  await page.evaluate(() => {
    location.hash = '#/drop';
    document.querySelector('#drop canvas.stage').getContext('webgl2').getExtension('WEBGL_lose_context').loseContext();
  });
  await page.waitForFunction(() => !document.querySelector('#drop .said').hidden && !window.sightline.drop.started);
  assert.equal(await text(page, '#drop .said'), 'The browser took WebGL from this page. Load it again to go on.');
}

test('its three parts work', async () => {
  await onPage(async (page) => {
    await clickModels(page);
    if (process.env.SIGHTLINE_FULL) await measure(page);
    await clickCity(page);
    await clickDrop(page);
    await goAbout(page);
    await loseWebGL(page);
  }, { width: 1400, height: 900 });
});

test('it names no number where the clock saw no time go by', () => {
  assert.equal(perSecond(0), '–');
  assert.equal(perSecond(16.7), '60 / s');
  assert.equal(perSecond(5000), '1 / s');
});

test('its server answers nonsense, and goes on', async () => {
  const { address, close } = await serve(), { port } = new URL(address);
  const ask = (path) => new Promise((resolve, reject) =>
    get({ port, path, agent: false }, (answer) => (answer.resume(), resolve(answer.statusCode))).on('error', reject));
  try {
    for (const path of ['/%', '/%00', '/%c3%28', '//']) assert.equal(await ask(path), 400, path);
    for (const path of ['/nothing', '/../serve.mjs', '/index.html/', `/${'a'.repeat(5000)}`]) assert.equal(await ask(path), 404, path);
    assert.equal(await ask('/'), 200);
  } finally {
    close();
  }
});

test('nothing is cut off, narrow and wide, light and dark', async () => {
  await onPage(async (page) => {
    const sizes = [[400, 'dark'], [1400, 'light'], [1400, 'dark'], [2000, 'light'], [700, 'light']];
    for (const [width, scheme] of process.env.SIGHTLINE_FULL ? sizes : sizes.slice(0, 2)) {
      await page.setViewportSize({ width, height: width < 600 ? 860 : 900 });
      await page.emulateMedia({ colorScheme: scheme });
      for (const part of ['models', 'city', 'drop']) {
        await page.click(`#tab-${part}`);
        await page.waitForFunction((name) => window.sightline[name].made || window.sightline[name].ready, part);
        // For the pictures.
        await page.waitForFunction((name) => document.querySelector(`#${name} .readout b`).textContent !== '–', part);
        await page.waitForTimeout(process.env.SIGHTLINE_FULL ? 900 : 300);
        const wide = await page.evaluate(() => document.documentElement.scrollWidth);
        assert.ok(wide <= width, `${part} at ${width} pixels is ${wide} wide`);
        writeFileSync(join(pictures, `${part}-${width}-${scheme}.png`), await page.screenshot({ fullPage: true }));
      }
    }
  });
});

test('without WebGPU it says so, and casts rays all the same', async () => {
  await onPage(async (page) => {
    await page.waitForFunction(() => window.sightline.models.rested);
    assert.match(await text(page, '#models .said'), /no WebGPU/);
    assert.equal(await page.locator('#models input[value="saa"]').isDisabled(), true);
    assert.ok((await page.evaluate(() => window.sightline.models.rested.kept)) > 50);
  }, { before: "Object.defineProperty(Navigator.prototype, 'gpu', { value: undefined });" });
});
