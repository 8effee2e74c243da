// node bench/city.mjs [COUNT] [FRAMES]: a three.js city of COUNT objects in Chromium (SwiftShader): how long render() keeps
// the main thread, and how long until SwiftShader has drawn it, without and with SightlineCuller, at street level and from above, where all is visible.
import { withPage } from '../test/browser/chromium.mjs';

const [count = 100_000, frames = 9] = process.argv.slice(2).map(Number);
await withPage(new URL('city.page.mjs', import.meta.url).pathname, async (tab) => {
  await tab.waitForFunction(() => window.time);
  for (const aerial of [false, true]) {
    for (const kind of ['instanced', 'batched', 'meshes']) {
      const result = await tab.evaluate((given) => window.time(...given), [kind, count, aerial, aerial ? Math.min(frames, 5) : frames]);
      console.log(`${aerial ? 'above' : 'street'} ${kind.padEnd(10)} without ${result.without.toFixed(1)} ms, ` +
        `with ${result.with.toFixed(1)} ms, ratio ${(result.with / result.without).toFixed(3)}, ${result.drawn} drawn; ` +
        `until it is drawn ${result.frames[0].toFixed(1)} and ${result.frames[1].toFixed(1)} ms`);
    }
  }
});
