// A page in Debian's Chromium, without a window, drawing on SwiftShader.
import { build } from 'esbuild';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { chromium } from 'playwright-core';

const flags = ['--headless=new', '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync', '--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader',
  '--enable-features=Vulkan', '--use-vulkan=swiftshader', '--use-angle=swiftshader'];
// Chromium's own words, whole, and what three.js says when a test takes WebGL from it.
const allowed = [
  /^THREE\.WebGLRenderer: Context Lost\.$/,
  /^\[.*\]Automatic fallback to software WebGL has been deprecated\. Please use the --enable-unsafe-swiftshader flag to opt in to lower security guarantees for trusted content\.$/,
  /^\[\.WebGL-0x[0-9a-f]+\]GL Driver Message \(OpenGL, Performance, GL_CLOSE_PATH_NV, High\): GPU stall due to ReadPixels/];

/** Opens an address and hands the page to `use`; fails on any message that the console shows. `before` is a script that runs in
 * the page first. */
export async function withAddress(address, use, { width = 1280, height = 720, before } = {}) {
  const folder = mkdtempSync(join(tmpdir(), 'sightline-chromium-'));
  const browser = await chromium.launchPersistentContext(folder, {
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: flags, headless: true, viewport: { width, height },
    ignoreDefaultArgs: ['--enable-unsafe-swiftshader'], timeout: 120_000 });
  const said = [];
  try {
    const page = await browser.newPage();
    page.setDefaultTimeout(300_000);
    page.on('console', (message) => said.push(`${message.type()}: ${message.text()}`));
    page.on('pageerror', (error) => said.push(`error: ${error.stack}`));
    if (before) await page.addInitScript(before);
    await page.goto(address);
    await use(page);
  } finally {
    await browser.close();
    rmSync(folder, { recursive: true, force: true });
  }
  const unexpected = said.filter((line) => !allowed.some((words) => words.test(line.replace(/^\w+: /, ''))));
  if (unexpected.length > 0) throw new Error(`the console says:\n${unexpected.join('\n')}`);
}

// What lets a page read the clock to 5 µs instead of 100.
const alone = { 'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp' };

/** Bundles a script, and opens a page that runs it. `files` are served besides, by their address; a page that `measures` has the
 * finer clock. */
export async function withPage(script, use, files = {}, { measures = false } = {}) {
  const bundle = await build({ entryPoints: [script], bundle: true, format: 'esm', target: 'esnext', write: false });
  const server = createServer((request, response) => {
    if (Object.hasOwn(files, request.url)) return void response.end(readFileSync(files[request.url]));
    if (measures) for (const [name, value] of Object.entries(alone)) response.setHeader(name, value);
    const isScript = request.url === '/page.js';
    response.setHeader('Content-Type', isScript ? 'text/javascript' : 'text/html');
    response.end(isScript ? bundle.outputFiles[0].text
      : '<!doctype html><link rel="icon" href="data:,"><body><script type="module" src="/page.js"></script>');
  });
  await new Promise((listening) => server.listen(0, '127.0.0.1', listening));
  try {
    await withAddress(`http://127.0.0.1:${server.address().port}/`, use);
  } finally {
    server.close();
  }
}
