// `sightline-culling/core`: worlds and their cull, in half the bytes.
import { bytes } from './bytes/core.js';
import { inflate, offer } from './runtime.js';

offer(1, () => inflate(bytes));
export * from './core-api.js';
export { World } from './world.js';
