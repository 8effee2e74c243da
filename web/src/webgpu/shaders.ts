// The GPU's part of iwcpa, bvha and saa (Ye et al. 2023). Operation for operation what the C++ library does, so that
// hits are the same to the bit: no product is added to, which a compiler might fuse.

/** What all of them share: structs as web/paper/rays.cpp lays them out, the slab test, and the nearest of two hits. */
const shared = /* wgsl */ `
struct Ray { origin: vec3f, reach: f32, inverse: vec3f, pad: f32 }
struct Node { low: vec3f, descendants: u32, high: vec3f, object: u32 }
struct Hit { object: u32, distance: f32 }
struct Call { rays: u32, first: u32, end: u32, more: u32 }
const nothing = 0xffffffffu;

// Narrows (entry, exit) by one slab. A ray along it is inside or misses, which no later slab undoes.
fn clip(span: vec2f, origin: f32, inverse: f32, low: f32, high: f32) -> vec2f {
  if (inverse == 0.0) {
    if (origin >= low && origin <= high) { return span; }
    return vec2f(1.0, -1.0);
  }
  let a = (low - origin) * inverse;
  let b = (high - origin) * inverse;
  let first = select(b, a, a < b);
  let last = select(a, b, a < b);
  return vec2f(select(span.x, first, first > span.x), select(span.y, last, last < span.y));
}

// Distance along the ray, 0 where it starts inside, -1 for a miss.
fn meet(ray: Ray, low: vec3f, high: vec3f) -> f32 {
  var span = vec2f(0.0, ray.reach);
  span = clip(span, ray.origin.x, ray.inverse.x, low.x, high.x);
  span = clip(span, ray.origin.y, ray.inverse.y, low.y, high.y);
  span = clip(span, ray.origin.z, ray.inverse.z, low.z, high.z);
  return select(-1.0, span.x, span.x <= span.y);
}

// Of equally near objects the lower id.
fn nearer(best: Hit, distance: f32, object: u32) -> Hit {
  if (distance < 0.0) { return best; }
  if (best.object == nothing || distance < best.distance || (distance == best.distance && object < best.object)) {
    return Hit(object, distance);
  }
  return best;
}
`;

/** What the arrays hold; boxes are six numbers each. */
const elements = {
  rays: 'Ray', boxes: 'f32', nodes: 'Node', candidates: 'u32', owners: 'u32', starts: 'u32', distances: 'f32', nearest: 'Hit', hits: 'Hit',
};
type Name = keyof typeof elements;

const boxOf = /* wgsl */ `
fn low(b: u32) -> vec3f { return vec3f(boxes[6u * b], boxes[6u * b + 1u], boxes[6u * b + 2u]); }
fn high(b: u32) -> vec3f { return vec3f(boxes[6u * b + 3u], boxes[6u * b + 4u], boxes[6u * b + 5u]); }`;

/** A shader's text: bound in this order the call, the arrays that it reads and the one that it writes. */
function shader(reads: Name[], writes: Name, code: string): string {
  const bound = [...reads.map((name) => ['read', name] as const), ['read_write', writes] as const].map(([access, name], i) =>
    `@group(0) @binding(${i + 1}) var<storage, ${access}> ${name}: array<${elements[name]}>;`);
  return [shared, '@group(0) @binding(0) var<uniform> call: Call;', ...bound, reads.includes('boxes') ? boxOf : '', code].join('\n');
}

/** A lane a ray, which keeps the nearest of what `loop` goes through, and of the earlier rounds if the call says so. */
function nearestOfEachRay(reads: Name[], loop: string): string {
  return shader(reads, 'hits', /* wgsl */ `
@compute @workgroup_size(256) fn main(@builtin(global_invocation_id) id: vec3u) {
  if (id.x >= call.rays) { return; }
  var best = Hit(nothing, -1.0);
  if (call.more != 0u) { best = hits[id.x]; }
  ${loop}
  hits[id.x] = best;
}`);
}

/** A lane a pair of ray and box, which leaves its distance: as printed. */
export const iwcpaDistances = shader(['rays', 'boxes'], 'distances', /* wgsl */ `
@compute @workgroup_size(16, 16) fn main(@builtin(global_invocation_id) id: vec3u) {
  let b = call.first + id.y;
  if (id.x >= call.rays || b >= call.end) { return; }
  distances[id.y * call.rays + id.x] = meet(rays[id.x], low(b), high(b));
}`);

/** The nearest of each ray's distances, and of the boxes of earlier rounds. */
export const iwcpaNearest = nearestOfEachRay(['distances'], /* wgsl */ `
  for (var b = call.first; b < call.end; b++) {
    best = nearer(best, distances[(b - call.first) * call.rays + id.x], b);
  }`);

/** The same tuned: a lane takes a ray and every sixteenth box of a strip, and keeps the nearest to itself. */
export const tunedPairs = shader(['rays', 'boxes'], 'nearest', /* wgsl */ `
const strip = 1024u;
@compute @workgroup_size(16, 16) fn main(@builtin(global_invocation_id) id: vec3u, @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_id) lane: vec3u) {
  if (id.x >= call.rays) { return; }
  let ray = rays[id.x];
  let begin = call.first + group.y * strip;
  let end = min(begin + strip, call.end);
  var best = Hit(nothing, -1.0);
  for (var b = begin + lane.y; b < end; b += 16u) { best = nearer(best, meet(ray, low(b), high(b)), b); }
  nearest[id.y * call.rays + id.x] = best;
}`);

/** The nearest of each ray over all rows of lanes, and over earlier rounds. */
export const tunedNearest = nearestOfEachRay(['nearest'], /* wgsl */ `
  for (var row = 0u; row < call.end; row++) {
    let hit = nearest[row * call.rays + id.x];
    best = nearer(best, hit.distance, hit.object);
  }`);

/** The distances of the candidates that the CPU collected, one a lane. Groups beyond a row of 65,535 lie in the next. */
export const bvhaDistances = shader(['rays', 'boxes', 'candidates', 'owners'], 'distances', /* wgsl */ `
@compute @workgroup_size(256) fn main(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32) {
  let c = (group.y * groups.x + group.x) * 256u + lane;
  if (c >= call.end) { return; }
  let b = candidates[c];
  distances[c] = meet(rays[owners[c]], low(b), high(b));
}`);

/** The nearest of each ray's candidates. */
export const bvhaNearest = nearestOfEachRay(['candidates', 'starts', 'distances'], /* wgsl */ `
  for (var c = starts[id.x]; c < starts[id.x + 1u]; c++) { best = nearer(best, distances[c], candidates[c]); }`);

/** Section 3.4.3: a ray a lane through the nodes depth first; a hit leads to the next node, a miss past its descendants. */
export const saa = nearestOfEachRay(['rays', 'nodes'], /* wgsl */ `
  let ray = rays[id.x];
  for (var i = 0u; i < call.end;) {
    let node = nodes[i];
    let distance = meet(ray, node.low, node.high);
    if (distance < 0.0) { i += 1u + node.descendants; continue; }
    if (node.object != nothing) { best = nearer(best, distance, node.object); }
    i++;
  }`);
