// node page/build.mjs: bundles the page into build/web/page: static files that any server serves, and that open from a disk, too.
// The package is built before (build.mjs).
import { build } from 'esbuild';
import { copyFileSync, mkdirSync, readdirSync, readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url)), root = dirname(dirname(here)), out = join(root, 'build/web/page');

const rows = (file) => {
  const [head, ...lines] = readFileSync(file, 'utf8').trim().split('\n').map((line) => line.split(','));
  return lines.map((line) => Object.fromEntries(head.map((name, i) => [name, line[i]])));
};

/** What is printed in table 6, and what the native program measures: of benchmarks/results, the first machine that has it. */
function figures() {
  const published = {}, native = {};
  for (const row of rows(join(root, 'workbench/reproduce/published/ray_pvs_times.csv'))) {
    const times = Object.entries(row).filter(([name, ms]) => /^[a-z]+_ms$/.test(name) && ms !== '-');
    published[row.model] = Object.fromEntries(times.map(([name, ms]) => [name.replace('_ms', ''), Number(ms)]));
  }
  const results = join(root, 'benchmarks/results');
  const machine = readdirSync(results, { withFileTypes: true }).find((entry) => entry.isDirectory());
  if (machine) {
    for (const row of rows(join(results, machine.name, 'rays.csv'))) {
      const model = row.benchmark.match(/^strata-(\d)$/)?.[1];
      if (!model) continue;
      native[model] ??= {};
      if (row.unit === 'ms') native[model][row.case] = Number(row.median);
      if (row.case === 'boca') native[model].kept = Number(row.kept);
      if (row.case === 'figure-13-ratio') native.figure13 = [Number(row.min), Number(row.max)];
      if (row.case === 'lost-share') native[model].lost_share = Number(row.median);
    }
  }
  return { published, native };
}

mkdirSync(out, { recursive: true });
await build({ entryPoints: [join(here, 'main.js')], outfile: join(out, 'page.js'), bundle: true, minify: true, format: 'iife', target: 'es2023',
  loader: { '.wasm': 'binary' }, define: { FIGURES: JSON.stringify(figures()) }, logLevel: 'warning' });
for (const name of ['index.html', 'page.css']) copyFileSync(join(here, name), join(out, name));
