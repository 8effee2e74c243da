// In the page: the GPU's methods on the five models, and what they say when something is missing.
import { GpuRays, gpuMethods, RaySet, ready } from 'sightline-culling/webgpu';
import { differing, read } from '../rays-file.mjs';

window.compare = async () => {
  await ready;
  const gpu = await GpuRays.start(), bad = [], bytes = await (await fetch('/rays.bin')).arrayBuffer();
  let casts = 0, hits = 0;
  for (const { model, boxes, side, views } of read(bytes)) {
    const set = new RaySet(boxes);
    for (const [v, expected] of views.entries()) {
      set.aim(expected.view, side, side);
      for (const method of gpuMethods) {
        const count = differing(await gpu.cast(set, method), expected);
        if (count > 0) bad.push(`${method}, model ${model}, view ${v}: ${count} rays`);
        ++casts;
      }
      hits += expected.objects.filter((object) => object !== 0xffffffff).length;
    }
    set.dispose();
  }
  gpu.dispose();
  return { casts, hits, bad, name: gpu.name };
};

const code = (promise) => promise.then(() => 'none', (error) => `${error.code}: ${error.message}`);
const eye = { worldToEye: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
  eyeToClip: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1.001, -1, 0, 0, -0.1001, 0], width: 64, height: 64 };

/** Three boxes side by side, each there twice: neighbours share faces, all have the same front. */
window.ties = async () => {
  const boxes = Float32Array.from([5, 0, 3, 1, 4, 2].flatMap((k) => {
    const x = 2 * (k >> 1) - 2;
    return [x - 1, -2, -8, x + 1, 2, -6];
  }));
  const set = new RaySet(boxes), gpu = await GpuRays.start();
  set.aim(eye, 33, 33);
  const expected = set.cast('toca'), bad = [];
  for (const method of ['boca', 'wide-rays']) if (differing(set.cast(method), expected) > 0) bad.push(method);
  for (const method of gpuMethods) if (differing(await gpu.cast(set, method), expected) > 0) bad.push(method);
  gpu.dispose(), set.dispose();
  return { bad, objects: [...new Set(expected.objects)] };
};

window.refusals = async () => {
  const device = await (await navigator.gpu.requestAdapter()).requestDevice();
  const boxes = Float32Array.from({ length: 6 * 2000 }, (_, i) => (i % 6 < 3 ? -9 : 1));
  const set = new RaySet(boxes), gpu = await GpuRays.start({ device });
  set.aim(eye, 100, 100);
  await gpu.cast(set, 'iwcpa');
  const during = code(gpu.cast(set, 'iwcpa'));
  await Promise.resolve();
  device.destroy();
  const result = { during: await during, after: await code(gpu.cast(set, 'saa')), lost: await gpu.lost };
  const other = await GpuRays.start();
  result.again = await code(other.cast(set, 'saa'));
  result.large = await code((set.aim(eye, 4096, 4096), other.cast(set, 'iwcpa')));
  other.dispose();
  result.disposed = await code(other.cast(set, 'saa'));
  result.unknown = await code(other.cast(set, 'sah'));
  Object.defineProperty(navigator.gpu, 'requestAdapter', { value: async () => null });
  result.none = await code(GpuRays.start());
  set.dispose();
  return result;
};
