// The package as its users get it: packed, installed into a project of its own, run in Node, bundled by esbuild and by Vite,
// type-checked strictly; the sizes it may have; what publint and @arethetypeswrong/cli say.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { cpSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, relative } from 'node:path';
import { after, before, test } from 'node:test';
import { gzipSync } from 'node:zlib';
import { checkPackage, Package } from '@arethetypeswrong/core';

const web = `${import.meta.dirname}/../`;
const tools = join(web, 'node_modules');
const run = (cwd, command, ...args) => execFileSync(command, args, { cwd, encoding: 'utf8', stdio: 'pipe' });
const tool = (cwd, script, ...args) => run(cwd, process.execPath, join(tools, script), ...args);
const esbuild = (cwd, ...args) => run(cwd, join(tools, 'esbuild/bin/esbuild'), ...args);  // no script, but a program

let project, tarball;
before(() => {
  project = mkdtempSync(join(tmpdir(), 'sightline-web-'));
  const [packed] = JSON.parse(run(web, 'npm', 'pack', '--json', '--pack-destination', project));
  tarball = join(project, packed.filename);
  writeFileSync(join(project, 'package.json'), '{ "name": "scratch", "type": "module", "private": true }');
  run(project, 'npm', 'install', '--offline', '--no-audit', '--no-fund', tarball);
  // What else the examples import is there already.
  for (const name of ['three', '@types', '@webgpu', 'typescript']) symlinkSync(join(tools, name), join(project, 'node_modules', name));
  cpSync(join(web, 'examples'), project, { recursive: true });
});
after(() => rmSync(project, { recursive: true, force: true }));

const seen = /^3 of 1000 in view: 0 1 2\n/;

test('the examples run in Node', () => {
  for (const example of ['first', 'core', 'wasm'])
    assert.match(run(project, process.execPath, `${example}.mjs`), seen, example);
});

test('esbuild bundles it, and the bundle runs', () => {
  esbuild(project, 'first.mjs', '--bundle', '--format=esm', '--outfile=out/first.mjs');
  assert.match(run(project, process.execPath, 'out/first.mjs'), seen);
});

test('Vite bundles it, and the bundle runs', () => {
  mkdirSync(join(project, 'page'));
  writeFileSync(join(project, 'page/index.html'), '<script type="module" src="../first.mjs"></script>');
  // Without what needs a document, to run it here.
  writeFileSync(join(project, 'page/vite.config.js'), `export default {
    build: { target: 'esnext', modulePreload: { polyfill: false } }, server: { fs: { allow: ['..'] } } };`);
  tool(project, 'vite/bin/vite.js', 'build', 'page', '--logLevel', 'error');
  const bundles = readdirSync(join(project, 'page/dist/assets'));
  assert.equal(bundles.length, 1);
  const out = run(project, process.execPath, join('page/dist/assets', bundles[0]));
  assert.match(out, seen);
});

test('a worker is bundled by Vite as it comes, and refused where it is missing', () => {
  mkdirSync(join(project, 'worker'));
  writeFileSync(join(project, 'worker/index.html'), '<script type="module" src="start.mjs"></script>');
  writeFileSync(join(project, 'worker/start.mjs'),
    "import { WorkerWorld } from 'sightline-culling/worker';\nWorkerWorld.start().catch((error) => console.log(error.code, error.message));\n");
  tool(project, 'vite/bin/vite.js', 'build', 'worker', '--logLevel', 'error');
  assert.ok(readdirSync(join(project, 'worker/dist/assets')).some((name) => name.startsWith('worker-thread')));
  esbuild(project, 'worker/start.mjs', '--bundle', '--format=esm', '--outfile=out/start.mjs');
  assert.match(run(project, process.execPath, 'out/start.mjs'), /^ended WorkerWorld: its thread has ended/);
});

test('types check strictly', () => {
  writeFileSync(join(project, 'tsconfig.json'), JSON.stringify({
    compilerOptions: { strict: true, module: 'NodeNext', target: 'ES2022', lib: ['ES2022', 'DOM'], types: ['@webgpu/types'], noEmit: true },
    files: ['types.ts'] }));
  tool(project, 'typescript/bin/tsc', '-p', '.');
  writeFileSync(join(project, 'types.ts'), "import { World } from 'sightline-culling';\nnew World().insert('boxes');\n");
  assert.throws(() => tool(project, 'typescript/bin/tsc', '-p', '.'), /Command failed/);
});

test('the whole takes at most 150 kB compressed, core 60, bytes included', () => {
  for (const [entry, limit] of [['sightline-culling', 150_000], ['sightline-culling/core', 60_000]]) {
    const source = join(project, 'size.mjs');
    writeFileSync(source, `export * from '${entry}';`);
    const bundle = esbuild(project, source, '--bundle', '--minify', '--format=esm');
    const size = gzipSync(bundle, { level: 9 }).length;
    assert.ok(size <= limit, `${entry}: ${size} bytes`);
    assert.ok(size > limit / 4, `${entry}: ${size} bytes, which cannot be all of it`);
  }
});

test('publint and @arethetypeswrong/cli find nothing', async () => {
  tool(project, 'publint/src/cli.js', 'run', tarball, '--strict');
  // By its library: the program itself unpacks only the end of a tarball of this size.
  const name = 'sightline-culling', root = join(project, 'node_modules', name);
  const paths = readdirSync(root, { recursive: true, withFileTypes: true }).filter((entry) => entry.isFile())
    .map((entry) => relative(root, join(entry.parentPath ?? entry.path, entry.name)));
  const files = Object.fromEntries(paths.map((path) => [`/node_modules/${name}/${path}`, readFileSync(join(root, path))]));
  const excludeEntrypoints = ['core.wasm', 'whole.wasm'];
  const { types, problems } = await checkPackage(new Package(files, name, '0.1.0'), { excludeEntrypoints });
  assert.equal(types.kind, 'included');
  // What a package of ES modules alone leaves out: resolution of before there were exports, and require().
  const expected = (problem) => problem.kind === 'CJSResolvesToESM' || problem.resolutionKind === 'node10';
  assert.deepEqual(problems.filter((problem) => !expected(problem)), []);
  assert.ok(problems.length > 0, 'it looked at nothing');
});

test('no module but three is needed', () => {
  const { dependencies, peerDependenciesMeta } = JSON.parse(readFileSync(join(web, 'package.json')));
  assert.equal(dependencies, undefined);
  assert.deepEqual(peerDependenciesMeta, { three: { optional: true } });
});
