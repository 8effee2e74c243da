export * from './core-api.js';
export { OccluderMesh, OcclusionBuffer } from './occlusion.js';
export { BoxBvh, noObject } from './rays.js';
export { CellPvs, type PvsArrays } from './pvs.js';
