// node build.mjs: builds dist/ — the two modules for WebAssembly by clang 19 and Binaryen, their bytes, packed by Zopfli, as
// strings, and the TypeScript. Everything that a package needs; `npm pack` makes it.
import { execFileSync } from 'node:child_process';
import { copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const root = dirname(here);
const run = (command, ...args) => execFileSync(command, args, { cwd: root, stdio: ['ignore', 'ignore', 'inherit'] });

// The package bears the library's version.
const version = readFileSync(join(root, 'include/sightline/version.hpp'), 'utf8').match(/\d+\.\d+\.\d+/)[0];
const manifest = JSON.parse(readFileSync(join(here, 'package.json')));
if (manifest.version !== version) throw new Error(`package.json says ${manifest.version}, the library ${version}`);

run('cmake', '--preset', 'wasm32', '-DSIGHTLINE_TESTS=OFF'); // which want GoogleTest's sources
run('cmake', '--build', 'build/wasm32', '--target', 'sightline_web_core', 'sightline_web_whole',
  'sightline_web_strata');

rmSync(join(here, 'dist'), { recursive: true, force: true });
mkdirSync(join(here, 'dist'));
mkdirSync(join(here, 'src/bytes'), { recursive: true });
mkdirSync(join(root, 'build/web/page'), { recursive: true });
const features = ['simd', 'bulk-memory', 'sign-ext', 'mutable-globals', 'nontrapping-float-to-int'];
for (const name of ['core', 'whole', 'strata']) {
  const out = name === 'strata' ? join(root, 'build/web/page/strata.wasm') : join(here, 'dist', `${name}.wasm`);
  // Nothing lies in the first kilobyte: the linker begins behind it.
  run('wasm-opt', '-O3', '--converge', '--low-memory-unused', ...features.map((feature) => `--enable-${feature}`), `build/wasm32/web/${name}.wasm`, '-o', out);
  if (name === 'strata') continue; // the page's alone
  const packed = execFileSync('zopfli', ['--gzip', '-c', out], { maxBuffer: 1 << 24 }).toString('base64');
  writeFileSync(join(here, 'src/bytes', `${name}.ts`), `// Made by build.mjs.\nexport const bytes =\n  '${packed}';\n`);
}
execFileSync(process.execPath, [join(here, 'node_modules/typescript/bin/tsc'), '-p', here], { stdio: 'inherit' });
copyFileSync(join(root, 'LICENSE'), join(here, 'LICENSE'));
