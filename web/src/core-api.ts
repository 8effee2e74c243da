export { SightlineError, type Code } from './errors.js';
export { ready, supported } from './runtime.js';
export { Block, bytes, doubles, floats, integers, type Input, type Numbers } from './memory.js';
export type { BoxArray, Boxes } from './boxes.js';
export { clipZeroToOne, type View } from './views.js';
export {
  allLayers, Culler, cullBoxes, cullSpheres, idOf, type Columns, type CullCosts, type Culled, type CullOptions, type CullView,
  type Handle, type Handles,
} from './world.js';
