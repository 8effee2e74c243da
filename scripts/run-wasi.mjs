// node run-wasi.mjs PROGRAM.wasm ARGUMENTS…: runs a program that was built for WASI, and exits as it does.
import { readFile } from 'node:fs/promises';
import { WASI } from 'node:wasi';

const [program, ...rest] = process.argv.slice(2);
const wasi = new WASI({
  version: 'preview1', args: [program, ...rest], env: process.env, preopens: { '/': '/' }, returnOnExit: true });
const { instance } = await WebAssembly.instantiate(
  await readFile(program), wasi.getImportObject());
process.exitCode = wasi.start(instance);
