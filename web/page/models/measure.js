// Table 6 and figures 12 and 13 of Ye et al. 2023, measured in this browser on this GPU.
import { RaySet } from 'sightline-culling/webgpu';
import { breath, median } from '../ui/elements.js';
import { isOnGpu, judge, methods } from './caster.js';
import { paperViewpoint, placeAround, viewFromAbove, viewOf } from './views.js';

const width = 1280, height = 720;

/** A frame drawn and waited for, in milliseconds. */
export function drawTime(renderer, view, objects, look, target = renderer.target(width, height)) {
  const start = performance.now();
  renderer.draw(view, objects, { target, look });
  renderer.finish(target);
  return performance.now() - start;
}

/** Table 6 of the model that is loaded: each method's milliseconds, ready and up to the first frame; and figure 12a's losses. */
export async function measureTable(stage, { rays = 100, repeats = 3, progress = () => {} } = {}) {
  const { renderer, caster, look } = stage, view = viewOf(paperViewpoint(), width, height);
  const named = methods.map(([name]) => name).filter((name) => !isOnGpu(name) || caster.gpu);
  const samples = Object.fromEntries(named.map((name) => [name, { ready: [], first: [] }]));
  let visible;
  for (const name of named) await caster.cast(name, view, rays); // pipelines and trees stand
  drawTime(renderer, view, renderer.all, look);
  for (let round = 0; round < repeats; ++round) {
    for (const [turn, name] of named.entries()) {
      const ready = await caster.cast(name, view, rays);
      samples[name].ready.push(ready.ms);
      samples[name].first.push(await first(stage, name, view, rays));
      visible = ready.visible;
      progress((round * named.length + turn + 1) / (repeats * named.length));
      await breath();
    }
  }
  const loss = judge(renderer.itemBuffer(view, width, height), visible, renderer.plan.count);
  const times = Object.fromEntries(named.map((name) => [name,
    { ready_ms: median(samples[name].ready), first_ms: median(samples[name].first) }]));
  return { model: renderer.plan.number, meshes: renderer.plan.count, triangles: renderer.plan.triangles, rays: rays * rays, repeats, times,
    differing: await caster.compare(view, rays), ...loss };
}

// From boxes on: tree and buffers, rays, and one frame that draws the set. (The boxes themselves come with the meshes.)
async function first({ renderer, caster, look }, name, view, rays) {
  const start = performance.now(), before = caster.set;
  caster.set = new RaySet(caster.boxes);
  try {
    const { visible } = await caster.cast(name, view, rays);
    drawTime(renderer, view, visible, look);
  } finally {
    caster.set.dispose(), (caster.set = before);
  }
  return performance.now() - start;
}

/** Figure 12: from V and from above, what the rays from V keep and what they cull. Two pictures as ImageData. */
export async function drawFigure12({ renderer, caster, look }, rays = 100, wide = 960) {
  const tall = Math.round((wide * 9) / 16), target = renderer.target(wide, tall), pictures = [];
  const { visible } = await caster.cast(isOnGpu('saa') && caster.gpu ? 'saa' : 'wide-rays', viewOf(paperViewpoint(), width, height), rays);
  renderer.tell(visible);
  for (const view of [viewOf(paperViewpoint(), wide, tall), viewFromAbove(caster.boxes, wide, tall)]) {
    renderer.draw(view, renderer.all, { target, look, byState: true, background: [...look.haze, 1] });
    const rows = renderer.read(target), picture = new ImageData(wide, tall);
    for (let y = 0; y < tall; ++y) picture.data.set(rows.subarray(4 * wide * (tall - 1 - y), 4 * wide * (tall - y)), 4 * wide * y);
    pictures.push(picture);
  }
  return { pictures, kept: visible.length };
}

/** Figure 13: all around the model, how many times as long everything takes to draw as the set alone. */
export async function measureFigure13({ renderer, caster, look }, { rays = 100, apart = 30, rise = 25, progress = () => {} } = {}) {
  const points = [], places = [];
  for (let above = 0; above < 80; above += rise) for (let aside = 0; aside < 360; aside += apart) places.push([aside, above]);
  drawTime(renderer, viewOf(paperViewpoint(), width, height), renderer.all, look);
  for (const [aside, above] of places) {
    const view = viewOf(placeAround(aside, above), width, height);
    const { visible } = await caster.cast('wide-rays', view, rays);
    const all = [], some = [];
    for (let round = 0; round < 3; ++round) all.push(drawTime(renderer, view, renderer.all, look)), some.push(drawTime(renderer, view, visible, look));
    points.push({ aside, above, kept: visible.length, everything_ms: median(all), pvs_ms: median(some), ratio: median(all) / median(some) });
    progress(points.length / places.length);
    await breath();
  }
  return points;
}
