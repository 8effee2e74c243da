// `sightline-culling/three` in a browser: the same pictures to the bit, fewer triangles.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import * as THREE from 'three';
import { ready, SightlineCuller } from 'sightline-culling/three';
import { add, look, places, random } from '../scenes/city.mjs';
import { withPage } from './browser/chromium.mjs';

const full = Boolean(process.env.SIGHTLINE_FULL);
const page = `${import.meta.dirname}/browser/equal.mjs`;

test('three.js draws the same with the culler, and less', async () => {
  await withPage(page, async (tab) => {
    await tab.waitForFunction(() => window.compare);
    const compare = (count, options) => tab.evaluate(([n, o]) => window.compare(n, o), [count, options]);
    const judge = (result, most) => {
      assert.equal(result.lost, 0, JSON.stringify(result));
      assert.ok(result.gaps <= result.frames / 50, JSON.stringify(result));
      assert.equal(result.disposed, 0);
      assert.ok(result.shown > 0.9 * result.frames);
      assert.ok(result.hidden > 0.1 * result.objects, JSON.stringify(result));
      assert.ok(result.callsOn < most * result.callsOff, JSON.stringify(result));
    };
    judge(await compare(full ? 2000 : Number(process.env.VIEWS ?? 500), { lit: false, antialias: true }), 0.7);
    judge(await compare(full ? 200 : Number(process.env.VIEWS ?? 40), { lit: true, antialias: true }), 0.9);
    assert.deepEqual(await tab.evaluate(() => window.changes()), { bad: [], own: 2, left: 0 });
    const { differing, own, whole, street } = await tab.evaluate(() => window.above());
    assert.deepEqual({ differing, whole }, { differing: 0, whole: 12 });
    assert.ok(own >= 10 && street < 0.5, `${own} frames left to three; at the street ${street} drawn`);
  });
});

test('of a batch that is culled what is drawn and has changed is sent alone', async () => {
  await withPage(page, async (tab) => {
    await tab.waitForFunction(() => window.batch);
    const { differing, whole, some, moved } = await tab.evaluate((views) => window.batch(views), full ? 400 : 30);
    assert.deepEqual(differing, []);
    assert.ok(some > 100 && moved > 100, `${some} matrices sent, ${moved} moved`);
    assert.ok(whole > 0 && whole < (full ? 1600 : 120), `all sent ${whole} times`);
  });
});

test('a mirror shows all that it would show without the culler', async () => {
  await withPage(page, async (tab) => {
    await tab.waitForFunction(() => window.mirror);
    for (const kind of ['batched', 'instanced', 'meshes']) {
      for (const still of [false, true])
        assert.deepEqual(await tab.evaluate((given) => window.mirror(...given), [8, kind, still]), { differs: [], own: false }, `${kind} ${still}`);
    }
  });
});

test('WebGPURenderer draws the same with the culler', async () => {
  await withPage(`${import.meta.dirname}/browser/webgpu.mjs`, async (tab) => {
    await tab.waitForFunction(() => window.compare);
    const result = await tab.evaluate((count) => window.compare(count), full ? 300 : 40);
    assert.equal(result.backend, 'webgpu');
    assert.equal(result.differing, 0, JSON.stringify(result));
    assert.ok(result.hidden > 0.2 * result.objects && result.shown > 30, JSON.stringify(result));
  });
});

// What a batch hands to WebGL: start, count and instance of each draw.
function listed(batch) {
  const { _multiDrawStarts: starts, _multiDrawCounts: counts, _indirectTexture: { image: { data } } } = batch;
  return Array.from({ length: batch._multiDrawCount }, (_, i) => `${starts[i]} ${counts[i]} ${data[i]}`);
}

test('instances of a batch are drawn in the order that three draws them in', async () => {
  await ready;
  const scene = new THREE.Scene(), { all: where, side } = places(4000), next = random(3), renderer = { isWebGLRenderer: true, sortObjects: true };
  for (let i = 0; i < where.length; i += 7) where[i] = where[0]; // equally far
  add(scene, 'batched', where, new THREE.MeshBasicMaterial());
  const [batch] = scene.children, { material } = batch, camera = new THREE.PerspectiveCamera(60, 1.5, 0.1, 500);
  const culler = new SightlineCuller(scene, { occlusion: false }), byIndex = (list) => list.sort((a, b) => b.index - a.index);
  await new Promise((loaded) => setTimeout(loaded, 10));
  const draw = () => batch.onBeforeRender(renderer, scene, camera, batch.geometry, material);
  draw(); // three's first list is of another eye: making spheres, it writes over it
  for (const [sorts, transparent, custom] of [[true, false], [true, true], [false, false], [true, false, byIndex]]) {
    Object.assign(batch, { sortObjects: sorts, customSort: custom ?? null }), (material.transparent = transparent);
    for (let view = 0; view < 20; ++view) {
      look(camera, next, side), camera.updateMatrixWorld(), scene.updateMatrixWorld();
      draw();
      const theirs = listed(batch);
      scene.onBeforeRender(renderer, scene, camera, null), draw(), scene.onAfterRender(renderer, scene, camera, null);
      const ours = listed(batch), all = new Set(theirs), both = new Set(ours.filter((draws) => all.has(draws)));
      const common = (list) => list.filter((draws) => both.has(draws)); // spheres and boxes let other things in at the edges
      assert.deepEqual(common(ours), common(theirs));
      assert.ok(both.size > 0.5 * theirs.length && both.size > 0.95 * ours.length, `${both.size} of ${ours.length}, ${theirs.length}`);
    }
  }
  // What a wireframe takes of them only three knows: it lists them as without the culler.
  material.wireframe = true, draw();
  const theirs = listed(batch);
  scene.onBeforeRender(renderer, scene, camera, null), draw(), scene.onAfterRender(renderer, scene, camera, null);
  assert.deepEqual(listed(batch), theirs);
  culler.dispose();
  assert.deepEqual(Object.keys(batch).filter((name) => /^(set|add|delete|optimize)/.test(name)), []);
});

test('what was removed counts no longer, and a scene that is all in view is left to three until the camera turns', async () => {
  await ready;
  const scene = new THREE.Scene(), { all, side } = places(900), renderer = { isWebGLRenderer: true, sortObjects: true };
  add(scene, 'meshes', all, new THREE.MeshBasicMaterial());
  const [group] = scene.children, own = scene.children, camera = new THREE.PerspectiveCamera(60, 1.5, 0.1, 2000);
  const culler = new SightlineCuller(scene, { occlusion: false });
  await new Promise((loaded) => setTimeout(loaded, 10));
  // Whether three walks the scene's own children.
  const draw = () => {
    camera.updateMatrixWorld(), scene.updateMatrixWorld();
    scene.onBeforeRender(renderer, scene, camera, null);
    const isOwn = scene.children === own;
    return scene.onAfterRender(renderer, scene, camera, null), isOwn;
  };
  const above = () => (camera.position.set(side / 2, 2 * side, side / 2), camera.lookAt(side / 2, 0, side / 2 + 1));
  for (const count of [900, 200]) {
    above();
    assert.equal(draw(), false);
    assert.deepEqual([culler.stats.objects, culler.stats.drawn], [count, count]);
    for (let frame = 0; frame < 8; ++frame) assert.equal(draw(), true);
    camera.rotateY(1.5); // away
    assert.equal(draw(), false);
    assert.ok(culler.stats.drawn < count / 2, `${culler.stats.drawn} drawn`);
    group.remove(...group.children.slice(0, 700));
  }
  culler.dispose();
});
