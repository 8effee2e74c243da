// `sightline-culling/three` in a browser: the same pictures to the bit, fewer triangles.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { withPage } from './browser/chromium.mjs';

const full = Boolean(process.env.SIGHTLINE_FULL);
const page = new URL('browser/equal.mjs', import.meta.url).pathname;

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

test('WebGPURenderer draws the same with the culler', async () => {
  await withPage(new URL('browser/webgpu.mjs', import.meta.url).pathname, async (tab) => {
    await tab.waitForFunction(() => window.compare);
    const result = await tab.evaluate((count) => window.compare(count), full ? 300 : 40);
    assert.equal(result.backend, 'webgpu');
    assert.equal(result.differing, 0, JSON.stringify(result));
    assert.ok(result.hidden > 0.2 * result.objects && result.shown > 30, JSON.stringify(result));
  });
});
