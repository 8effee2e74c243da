// One model's rays by any method: here, or on the GPU where there is one.
import { cpuMethods, GpuRays, gpuMethods, RaySet, ready, visibleSet } from 'sightline-culling/webgpu';

/** In the paper's order, then ours. */
export const methods = [
  ['toca', 'every ray at every box, on the CPU'], ['boca', 'every ray down a tree, on the CPU'],
  ['iwcpa', 'every pair of ray and box at once, on the GPU, as printed'], ['bvha', 'the tree on the CPU, distances on the GPU'],
  ['saa', 'the tree laid flat, a ray a lane, on the GPU'], ['tuned-iwcpa', 'iwcpa, where a lane keeps the nearest to itself'],
  ['wide-rays', 'ours: eight boxes at once, on the CPU']];
export const isOnGpu = (method) => gpuMethods.includes(method);
export { cpuMethods };

export class Caster {
  /** The GPU, if any: `gpu` undefined says, in `why`, what is missing. Throws where there is no WebAssembly with SIMD. */
  static async start() {
    await ready;
    const caster = new Caster();
    await caster.restart();
    return caster;
  }
  async restart() {
    try {
      this.gpu = await GpuRays.start(), (this.why = undefined);
      void this.gpu.lost.then((why) => ((this.gpu = undefined), (this.why = why), this.onlost?.(why)));
    } catch (error) {
      this.gpu = undefined, (this.why = error.message);
    }
  }
  /** Takes a model's boxes. */
  take(boxes) {
    this.set?.dispose();
    this.boxes = boxes, (this.set = new RaySet(boxes));
  }

  /** The visible set of a view by columns × rows rays; times in milliseconds. Where a method needs a GPU that is not there, boca
   * does it, and `by` says so: the set is the same. */
  async cast(method, view, columns, rows = columns) {
    const by = isOnGpu(method) && !this.gpu ? 'boca' : method, start = performance.now();
    this.set.aim(view, columns, rows);
    const aimed = performance.now();
    const hits = isOnGpu(by) ? await this.gpu.cast(this.set, by) : this.set.cast(by);
    const done = performance.now();
    const times = hits.times ?? { cpu: done - aimed, upload: 0, compute: 0, readBack: 0 };
    return { by, hits, visible: visibleSet(hits, this.set.size), times, ms: times.cpu + times.upload + times.compute + times.readBack,
      whole: done - start };
  }

  /** Rays of which methods disagree, against toca where that is not too slow, else boca: none, if the GPU rounds as it should. */
  async compare(view, side) {
    const found = {}, reference = await this.cast('boca', view, side);
    for (const [method] of methods) {
      if (isOnGpu(method) && !this.gpu) continue;
      const { hits } = await this.cast(method, view, side);
      const a = new Uint32Array(hits.distances.buffer), b = new Uint32Array(reference.hits.distances.buffer);
      found[method] = hits.objects.reduce((sum, object, r) => sum + (object !== reference.hits.objects[r] || a[r] !== b[r] ? 1 : 0), 0);
    }
    return found;
  }
}

/** What a set loses beside the item buffer. */
export function judge(items, visible, objects) {
  const pixels = new Uint32Array(objects + 1), kept = new Uint8Array(objects + 1);
  for (const item of items) ++pixels[item];
  for (const object of visible) kept[object + 1] = 1;
  const loss = { visible: 0, kept: visible.length, lostObjects: 0, lostPixels: 0, objectPixels: 0 };
  for (let item = 1; item <= objects; ++item) {
    if (pixels[item] === 0) continue;
    ++loss.visible, (loss.objectPixels += pixels[item]);
    if (!kept[item]) ++loss.lostObjects, (loss.lostPixels += pixels[item]);
  }
  return loss;
}
