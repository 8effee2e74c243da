// What a strict TypeScript project sees.
import { Scene } from 'three';
import { GpuRays, RaySet, visibleSet, type GpuHits } from 'sightline-culling/webgpu';
import { SightlineTilesPlugin } from 'sightline-culling/three-tiles';
import { SightlineCuller, type SightlineStats } from 'sightline-culling/three';
import { BoxBvh, Culler, integers, OcclusionBuffer, ready, SightlineError, World, type CullView } from 'sightline-culling';
import { initialise } from 'sightline-culling/wasm';
import { World as CoreWorld } from 'sightline-culling/core';
import { WorkerWorld } from 'sightline-culling/worker';

export async function draw(view: CullView): Promise<Uint32Array> {
  await ready;
  const world: World = new World(), core: CoreWorld = new CoreWorld();
  const handles: Float64Array = world.insert(new Float32Array(6), { layers: Uint32Array.of(1) });
  world.move(handles, { data: new Float64Array(6), layout: 'centre-half' });
  const buffer = new OcclusionBuffer();
  buffer.begin(view);
  try {
    return new Culler().cull(core, { ...view, occlusion: buffer }).ids;
  } catch (error) {
    if (error instanceof SightlineError && error.code === 'bad_view') return integers(0).array;
    throw error;
  }
}
export const later: (bytes: ArrayBuffer) => Promise<void> = initialise;
export const threads: Promise<WorkerWorld> = WorkerWorld.start();
export const tree: BoxBvh = new BoxBvh();
export const stats: SightlineStats = new SightlineCuller(new Scene(), { occlusion: true }).stats;
export async function rays(view: CullView): Promise<Uint32Array> {
  const set = new RaySet(Float32Array.of(0, 0, 0, 1, 1, 1));
  set.aim(view, 10, 10);
  const hits: GpuHits = await (await GpuRays.start()).cast(set, 'saa');
  return visibleSet(hits, set.size);
}
export const plugin: SightlineTilesPlugin = new SightlineTilesPlugin({ mostTriangles: 1000 });
