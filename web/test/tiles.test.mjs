// `sightline-culling/three-tiles` with 3DTilesRendererJS: the same picture of fewer tiles.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { withPage } from './browser/chromium.mjs';

test('tiles behind a wall are neither refined nor loaded, and the picture is the same', async () => {
  await withPage(`${import.meta.dirname}/browser/tiles.mjs`, async (tab) => {
    await tab.waitForFunction(() => window.compare);
    const views = await tab.evaluate(() => window.compare());
    if (process.env.VERBOSE) console.log(views);
    const [street, siblings, close, above] = views;
    for (const view of [street, siblings, close, above]) {
      assert.equal(view.differing, 0, JSON.stringify(view));
      assert.ok(view.colours > (view === close ? 0 : 2) && view.occluders > 0, JSON.stringify(view)); // close up, the wall is all there is
    }
    assert.ok(street.asked[1] < 0.7 * street.asked[0] && street.shown[1] < 0.7 * street.shown[0], JSON.stringify(street));
    assert.ok(siblings.asked[1] < 0.9 * siblings.asked[0], JSON.stringify(siblings));
    // What is asked for before the wall is there cannot be known to be hidden.
    assert.ok(close.asked[1] < 0.6 * close.asked[0] && close.shown[1] === 1, JSON.stringify(close));
    assert.ok(above.asked[1] > 0.5 * above.asked[0], JSON.stringify(above));
  });
});
