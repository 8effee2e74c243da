// The module's bytes in a file of their own; a page fetches them: initialise(fetch(url)).
import { readFile } from 'node:fs/promises';
import * as sightline from 'sightline-culling/wasm';
import { cullARow } from './row.mjs';

await sightline.initialise(readFile(new URL(import.meta.resolve('sightline-culling/whole.wasm'))));
cullARow(sightline);
