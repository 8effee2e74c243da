// node bench/city.mjs [COUNT] [FRAMES] [--csv FILE]: a three.js city of COUNT objects in Chromium (SwiftShader): how long render() keeps
// the main thread, and how long until SwiftShader has drawn it, without and with SightlineCuller, at street level and from above, where all is visible.
import { withPage } from '../test/browser/chromium.mjs';
import { writeRows } from './csv.mjs';

const [count = 100_000, frames = 9] = process.argv.slice(2).filter((word) => /^\d+$/.test(word)).map(Number);
const times = {}, beside = {};
await withPage(new URL('city.page.mjs', import.meta.url).pathname, async (tab) => {
  await tab.waitForFunction(() => window.time);
  for (const aerial of [false, true]) {
    for (const kind of ['instanced', 'batched', 'meshes']) {
      const result = await tab.evaluate((given) => window.time(...given), [kind, count, aerial, aerial ? Math.min(frames, 5) : frames]);
      const name = `${aerial ? 'above' : 'street'}-${kind}`;
      times[name] = result.without, (times[`${name}-culled`] = result.with), (beside[name] = [`${name}-culled`]);
    }
  }
});
writeRows('city', times, beside);
