export * from './core-api.js';
export { noOccluder, World, type Occluder, type OccluderId } from './occluders.js';
export { OccluderMesh, OcclusionBuffer, type OcclusionOptions, type Sides } from './occlusion.js';
export { BoxBvh, noObject } from './rays.js';
export { CellPvs, type PvsArrays } from './pvs.js';
