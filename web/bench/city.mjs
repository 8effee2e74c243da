// node bench/city.mjs [COUNT] [FRAMES] [KIND…] [--csv FILE]: a three.js city of COUNT objects in Chromium (SwiftShader): how long
// render() keeps the main thread, and until SwiftShader has drawn it, without and with SightlineCuller, at street level and from
// above, where all is visible; as `instanced`, `batched`, `meshes`, or, at street level, `ranges`: instances whose moves are told by
// updateRanges, and `restless`: instances that all move. The canvas is small, so that what a CPU draws in place of a GPU takes
// reasonable time; what the main thread does is the same. Frames before those that are timed let the compilers finish with both
// sides: a program that draws every frame has that behind it.
import { withPage } from '../test/browser/chromium.mjs';
import { writeRows } from './csv.mjs';

const [count = 100_000, frames = 41] = process.argv.slice(2).filter((word) => /^\d+$/.test(word)).map(Number);
const all = ['instanced', 'batched', 'meshes', 'ranges', 'restless'], given = all.filter((kind) => process.argv.includes(kind));
// The browser's clock ticks every 5 us, too seldom for a frame that takes 400: there ten frames make one time.
const byTens = (all) => Array.from({ length: all.length / 10 }, (_, k) => all.slice(10 * k, 10 * k + 10).reduce((sum, one) => sum + one / 10, 0));
const kinds = given.length > 0 ? given : all, times = {}, beside = {};
await withPage(`${import.meta.dirname}/city.page.mjs`, async (tab) => {
  await tab.waitForFunction(() => window.time);
  for (const aerial of [false, true]) {
    for (const kind of kinds) {
      if (aerial && all.indexOf(kind) > 2) continue;
      const result = await tab.evaluate((given) => window.time(...given),
        [kind, count, aerial, { warm: 40, timed: aerial && kind === 'instanced' ? 10 * frames : frames, drawn: Math.min(frames, 9) }]);
      if (result.thread[0].length > frames) result.thread = result.thread.map(byTens);
      const name = `${aerial ? 'above' : 'street'}-${kind}`, drawn = `${name}-drawn`;
      [times[name], times[`${name}-culled`]] = result.thread, (beside[name] = [`${name}-culled`]);
      // Until it is drawn, the GPU's part included.
      [times[drawn], times[`${drawn}-culled`]] = result.whole, (beside[drawn] = [`${drawn}-culled`]);
      console.log(`${name}: ${result.kept} of ${count} drawn`);
    }
  }
}, {}, { measures: true });
writeRows('city', times, beside);
