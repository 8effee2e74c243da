// `sightline-culling/webgpu`: visible sets by rays at boxes, as Ye et al. 2023 find them, on the GPU and here.
//
//   const set = new RaySet(boxes);                 // six numbers a box
//   set.aim(view, 100, 100);
//   const gpu = await GpuRays.start();             // throws where there is no WebGPU
//   const visible = visibleSet(await gpu.cast(set, 'saa'), set.size);
//
// All methods meet the same objects at the same distances, to the bit where the GPU rounds as IEEE 754 asks.
import '../index.js';

export { SightlineError } from '../errors.js';
export { ready, supported } from '../runtime.js';
export { noObject } from '../rays.js';
export type { View } from '../views.js';
export { cpuMethods, RaySet, visibleSet, type CpuMethod, type RayHits } from './rays.js';
export { GpuRays, gpuMethods, hasWebGpu, type CastTimes, type GpuHits, type GpuMethod } from './gpu.js';
