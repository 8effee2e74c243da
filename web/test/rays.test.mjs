// `sightline-culling/webgpu`: the same hits as the C++ library on this processor, to the bit, on the five models; here by
// WebAssembly, in Chromium by WGSL.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { bytes } from 'sightline-culling';
import { cpuMethods, GpuRays, noObject, RaySet, ready, visibleSet } from 'sightline-culling/webgpu';
import { Models } from '../page/models/models.js';
import { withPage } from './browser/chromium.mjs';
import { differing, read } from './rays-file.mjs';

const file = `${import.meta.dirname}/../../build/web/rays.bin`;
const triangles = Number(process.env.SIGHTLINE_RAY_TRIANGLES ?? 0);
const natively = () => {
  const read = readFileSync(file);
  return read.buffer.slice(read.byteOffset, read.byteOffset + read.byteLength);
};

test('toca, boca and wide-rays meet what they meet natively', async () => {
  await ready;
  let models = 0;
  for (const { model, boxes, side, views } of read(natively())) {
    const set = new RaySet(boxes);
    assert.equal(set.nodes.length, 32 * (2 * set.size - 1));
    let most = 0; // what is seen: from some places that is little
    for (const [v, expected] of views.entries()) {
      set.aim(expected.view, side, side);
      for (const method of cpuMethods) {
        const hits = set.cast(method);
        assert.equal(differing(hits, expected), 0, `${method}, model ${model}, view ${v}`);
        most = Math.max(most, visibleSet(hits, set.size).length);
      }
    }
    const hits = set.cast('boca'), into = { objects: new Uint32Array(set.rays), distances: new Float32Array(set.rays) };
    assert.equal(set.cast('wide-rays', into), into);
    assert.deepEqual(into, hits);
    assert.ok(most > 20, `model ${model}: ${most}`);
    set.dispose();
    ++models;
  }
  assert.equal(models, 5);
});

test("the page's models are the native ones", async () => {
  const models = await Models.start(readFileSync(new URL('../../build/web/page/strata.wasm', import.meta.url)));
  for (const { model, boxes } of read(natively())) {
    const plan = models.plan(model, triangles || undefined);
    for (let piece = 0; piece < plan.count; ++piece) models.make(piece);
    const made = models.centre().boxes;
    let differing = Math.abs(made.length - boxes.length);
    boxes.forEach((x, i) => (differing += made[i] === x ? 0 : 1));
    assert.equal(differing, 0, `model ${model}: ${differing} of ${boxes.length} numbers of its boxes differ`);
  }
});

test('iwcpa, bvha and saa on the GPU meet what they meet natively', async () => {
  await withPage(`${import.meta.dirname}/browser/rays.mjs`, async (tab) => {
    await tab.waitForFunction(() => window.compare);
    const result = await tab.evaluate(() => window.compare());
    assert.deepEqual(result.bad, []);
    assert.ok(result.casts >= 20 && result.hits > 1000, JSON.stringify(result));
    const ties = await tab.evaluate(() => window.ties());
    assert.deepEqual(ties.bad, []);
    assert.deepEqual(ties.objects.toSorted((a, b) => a - b), [0, 1, 2, noObject]);
    const said = await tab.evaluate(() => window.refusals());
    assert.match(said.during, /^lost: sightline: the GPU's device was lost/);
    assert.match(said.after, /^lost: sightline: the GPU's device was lost/);
    assert.match(said.lost, /start another, or cast on the CPU/);
    assert.equal(said.again, 'none');
    assert.match(said.large, /^(none|too_many: sightline: .*cast fewer rays)$/);
    assert.match(said.disposed, /^disposed: GpuRays: used after dispose/);
    assert.match(said.unknown, /^bad_argument: cast: a method of sah/);
    assert.match(said.none, /^unsupported: sightline: WebGPU has no adapter here/);
  }, { '/rays.bin': file });
});

test('1,000 rounds of rays leak nothing', async () => {
  await ready;
  const boxes = Float32Array.from({ length: 6 * 300 }, (_, i) => (i % 6 < 3 ? 0 : 1) + Math.floor(i / 6) % 17 - 9);
  const view = { worldToEye: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
    eyeToClip: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1.001, -1, 0, 0, -0.1001, 0], width: 64, height: 64 };
  const round = () => {
    const set = new RaySet(boxes);
    set.aim(view, 8, 8), cpuMethods.forEach((method) => set.cast(method)), set.collect();
    assert.throws(() => set.update(new Float32Array(5)));
    set.dispose();
  };
  for (let i = 0; i < 20; ++i) round();
  const probe = bytes(1), size = probe.array.buffer.byteLength;
  for (let i = 0; i < 1000; ++i) round();
  assert.equal(probe.array.buffer.byteLength, size);
});

test('rays refuse what is not sound, and Node has no GPU', async () => {
  await ready;
  const refusal = (code, words) => (error) => error.code === code && words.test(error.message);
  assert.throws(() => new RaySet(new Float32Array(7)), refusal('bad_argument', /7 numbers/));
  assert.throws(() => new RaySet(Float32Array.of(0, 0, 0, 1, 1, NaN)), refusal('bad_box', /index 0/));
  const set = new RaySet(Float32Array.of(-1, -1, -6, 1, 1, -5));
  const view = { worldToEye: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
    eyeToClip: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1.001, -1, 0, 0, -0.1001, 0], width: 64, height: 64 };
  assert.throws(() => set.aim(view, 0, 4), refusal('bad_argument', /1 to 4096/));
  assert.throws(() => set.aim({ ...view, origin: [1, 0, 0] }, 4, 4), refusal('bad_view', /origin/));
  set.aim(view, 3, 3);
  assert.throws(() => set.cast('iwcpa'), refusal('bad_argument', /expected toca, boca, wide-rays/));
  const hits = (objects, distances) => ({ objects: new Uint32Array(objects), distances: new Float32Array(distances) });
  assert.throws(() => set.cast('toca', hits(9, 8)), refusal('bad_argument', /into: 8 elements, expected 9/));
  assert.throws(() => set.cast('toca', { ...hits(9, 9), objects: [] }), refusal('bad_argument', /objects as a Uint32Array/));
  assert.deepEqual([...set.cast('toca').objects], [noObject, noObject, noObject, noObject, 0, noObject, noObject, noObject, noObject]);
  set.dispose();
  assert.throws(() => set.cast('toca'), refusal('disposed', /RaySet: used after dispose/));
  if (typeof navigator === 'undefined' || !navigator.gpu) await assert.rejects(GpuRays.start(), refusal('unsupported', /no WebGPU/));
});
