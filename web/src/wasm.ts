// `sightline-culling/wasm`: all of it, without bytes. Give it those of `sightline-culling/whole.wasm` (or `/core.wasm`),
// wherever you keep them: await initialise(fetch(url)).
export * from './whole-api.js';
export { initialise, type Source } from './runtime.js';
