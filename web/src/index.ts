// `sightline-culling`: all of it, the module's bytes inlined.
import { bytes } from './bytes/whole.js';
import { inflate, offer } from './runtime.js';

offer(2, () => inflate(bytes));
export * from './whole-api.js';
