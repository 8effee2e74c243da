// node bench/bench.mjs [COUNT] [--csv FILE]: how long culling a million boxes takes in Node, of which a tenth is in view, and casting
// 10,000 rays, beside three.js and its libraries, a loop by hand, and the same calls natively with SSE4: medians, interleaved, in
// one process but for the native ones, which run between the rounds. Built before: web/build.mjs, and the targets
// sightline_web_simd128 (preset wasm32) and sightline_web_bench (preset release).
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { InstancedMesh2 } from '@three.ez/instanced-mesh';
import * as THREE from 'three';
import { MeshBVH } from 'three-mesh-bvh';
import { BoxBvh, bytes, Culler, cullBoxes, floats, integers, noObject, OcclusionBuffer, ready, World } from 'sightline-culling';
import { RaySet } from 'sightline-culling/webgpu';
import { writeRows } from './csv.mjs';

const started = performance.now();
await ready;
new Culler().cull(new World(), { worldToEye: new THREE.Matrix4().elements, eyeToClip: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0,
  -0.1, 0], width: 1, height: 1 });
const first = performance.now() - started;

const count = Number(process.argv.slice(2).find((word) => /^\d+$/.test(word)) ?? 1e6), side = 4000;
let seed = 1;
const next = () => ((seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) / 2 ** 32);
const boxes = floats(6 * count), columns = floats(6 * count), three = [];
for (let i = 0; i < count; ++i) {
  const at = [(next() - 0.5) * side, next() * 50, (next() - 0.5) * side], half = 0.5 + next();
  at.forEach((x, k) => {
    boxes.array[6 * i + k] = columns.array[k * count + i] = x - half;
    boxes.array[6 * i + 3 + k] = columns.array[(3 + k) * count + i] = x + half;
  });
  three.push(new THREE.Box3(new THREE.Vector3(...boxes.array.subarray(6 * i, 6 * i + 3)),
    new THREE.Vector3(...boxes.array.subarray(6 * i + 3, 6 * i + 6))));
}
const camera = new THREE.PerspectiveCamera(50, 16 / 9, 0.1, 1390);
camera.position.set(0, 20, 800), camera.updateMatrixWorld();
const projection = new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
const frustum = new THREE.Frustum().setFromProjectionMatrix(projection);
const p = Array.from(camera.projectionMatrix.elements);
for (let c = 0; c < 4; ++c) p[4 * c + 2] = (p[4 * c + 2] + p[4 * c + 3]) / 2;
const view = { worldToEye: camera.matrixWorldInverse.elements, eyeToClip: p, width: 1280, height: 720 };

const world = new World(), culler = new Culler(), out = integers(count + 64);
const handles = world.insert(boxes);
const mesh = new InstancedMesh2(new THREE.BoxGeometry(1, 1, 1), new THREE.MeshBasicMaterial(), { capacity: count,
  createEntities: false });
const buildStarted = performance.now(), matrix = new THREE.Matrix4();
mesh.addInstances(count, () => {});
const place = (i) => {
  const { min, max } = three[i];
  matrix.makeScale(max.x - min.x, max.y - min.y, max.z - min.z).setPosition((min.x + max.x) / 2, (min.y + max.y) / 2,
    (min.z + max.z) / 2);
  mesh.setMatrixAt(i, matrix);
};
for (let i = 0; i < count; ++i) place(i);
mesh.computeBVH({ margin: 0 });
console.log(`InstancedMesh2: built in ${((performance.now() - buildStarted) / 1000).toFixed(1)} s`);

// A hundredth moves: the same things frame after frame, or others each time.
class Movers {
  constructor(others) {
    this.others = others, (this.frame = 0);
    this.indices = Uint32Array.from({ length: count / 100 }, (_, k) => 100 * k);
    this.handles = new Float64Array(count / 100), (this.to = new Float32Array(6 * (count / 100)));
    this.matrices = Array.from(this.indices, () => new THREE.Matrix4());
  }
  // Where they go next: not timed.
  goOn() {
    const array = boxes.array;
    if (this.others) this.frame = (this.frame + 37) % 100;
    for (let k = 0; k < this.indices.length; ++k) {
      const i = (this.indices[k] = 100 * k + this.frame), { min, max } = three[i];
      for (const axis of [0, 3]) array[6 * i + axis] += 0.125;
      min.x += 0.125, (max.x += 0.125);
      this.handles[k] = handles[i];
      for (let c = 0; c < 6; ++c) this.to[6 * k + c] = array[6 * i + c];
      this.matrices[k].makeScale(max.x - min.x, max.y - min.y, max.z - min.z).setPosition((min.x + max.x) / 2, (min.y + max.y) / 2, (min.z + max.z) / 2);
    }
  }
  move() {
    world.move(this.handles, this.to);
    return culler.cull(world, view).ids.length;
  }
  moveTheirs() {
    for (let k = 0; k < this.indices.length; ++k) mesh.setMatrixAt(this.indices[k], this.matrices[k]), mesh.bvh.move(this.indices[k]);
    return theirs();
  }
}
const same = new Movers(false), others = new Movers(true);
const theirs = () => {
  let seen = 0;
  mesh.bvh.frustumCulling(projection, () => ++seen);
  return seen;
};
const three_loop = () => {
  let seen = 0;
  for (let i = 0; i < count; ++i) if (frustum.intersectsBox(three[i])) ++seen;
  return seen;
};

const rays = 10000, some = Math.min(count, 17773);
const bvh = new BoxBvh(), rayData = floats(7 * rays), objects = integers(rays), distances = floats(rays);
bvh.build(boxes.array.subarray(0, 6 * some));
const cube = new THREE.BoxGeometry(1, 1, 1), position = [], index = [];
for (let i = 0; i < some; ++i) {
  const { min, max } = three[i], size = max.clone().sub(min), centre = min.clone().add(max).multiplyScalar(0.5);
  for (const v of cube.index.array) index.push(v + 24 * i);
  for (let v = 0; v < 24; ++v) for (const axis of ['x', 'y', 'z'])
    position.push(cube.attributes.position[`get${axis.toUpperCase()}`](v) * size[axis] + centre[axis]);
}
const triangles = new THREE.BufferGeometry().setAttribute('position', new THREE.Float32BufferAttribute(position, 3));
triangles.setIndex(index);
// The same rays for all: through the middles of 100 x 100 parts of a view's image.
const meshBvh = new MeshBVH(triangles), threeRays = [], set = new RaySet(boxes.array.slice(0, 6 * some));
set.aim({ ...view, eyeToClip: [1.2, 0, 0, 0, 0, 2, 0, 0, 0, 0, -1, -1, 0, 0, -0.1, 0] }, 100, 100);
for (let r = 0; r < rays; ++r) {
  const direction = new THREE.Vector3(((r % 100) - 49.5) / 60, (49.5 - Math.floor(r / 100)) / 100, -1);
  threeRays.push(new THREE.Ray(camera.position.clone(), direction.normalize()));
  rayData.array.set([...camera.position, ...direction, Infinity], 7 * r);
}
const met = set.cast('wide-rays');
const castTheirs = () => {
  let hits = 0;
  for (const ray of threeRays) if (meshBvh.raycastFirst(ray, THREE.DoubleSide)) ++hits;
  return hits;
};
const castOurs = () => {
  bvh.cast(rayData, objects, distances);
  return hitsIn(objects.array);
};
const hitsIn = (all) => {
  let hits = 0;
  for (let r = 0; r < rays; ++r) if (all[r] !== noObject) ++hits;
  return hits;
};

// --- a loop by hand, in a module of its own ---
const build = `${import.meta.dirname}/../../build`;
const plain = (await WebAssembly.instantiate(readFileSync(join(build, 'wasm32/web/simd128.wasm')), {})).instance.exports;
const heap = Math.ceil(plain.heap() / 64) * 64, planesAt = heap + 24 * count, idsAt = planesAt + 128;
plain.memory.grow(Math.ceil((idsAt + 4 * count - plain.memory.buffer.byteLength) / 65536));
new Float32Array(plain.memory.buffer, heap, 6 * count).set(columns.array);
frustum.planes.forEach(({ normal, constant }, i) =>
  new Float32Array(plain.memory.buffer, planesAt + 16 * i, 4).set([normal.x, normal.y, normal.z, constant]));
const byHand = () => plain.cull(heap, count, planesAt, idsAt);

// --- occluders ---
const walls = 200, wall = floats(6 * walls), buffer = new OcclusionBuffer(), asked = Math.min(count, 20_000), seen = bytes(asked);
for (let i = 0; i < walls; ++i) {
  const x = (next() - 0.5) * 600, z = 700 - 600 * next();
  wall.array.set([x - 8, 0, z - 8, x + 8, 30 * (0.5 + next()), z + 8], 6 * i);
}
const drawWalls = () => (buffer.begin(view), buffer.drawBoxes(wall), walls);
const askBoxes = () => (buffer.maySee({ data: boxes.array.subarray(0, 6 * asked) }, seen), seen.array.reduce((a, b) => a + b, 0));

// --- the same natively ---
const native = join(build, 'release/web/sightline_web_bench');
const folder = mkdtempSync(join(tmpdir(), 'sightline-bench-')), file = join(folder, 'input');
writeFileSync(file, Buffer.concat([Uint32Array.of(count, walls), Float32Array.from(view.worldToEye), Float32Array.from(view.eyeToClip),
  boxes.array, columns.array, wall.array].map((array) => Buffer.from(array.buffer, array.byteOffset, array.byteLength))));
const natively = {};
function runNative() {
  for (const line of execFileSync(native, [file], { encoding: 'utf8' }).trim().split('\n')) {
    const [name, ms, answer] = line.split(',');
    (natively[name] ??= []).push(Number(ms)), (answers[`native-${name}`] = Number(answer));
  }
}

// Nothing has moved yet; then a hundredth does.
const still = {
  'World.cull': () => culler.cull(world, view).ids.length,
  cullBoxes: () => cullBoxes(view, { data: columns, layout: 'columns' }, out),
  'by-hand': byHand,
  'three-intersectsBox': three_loop,
  'InstancedMesh2-bvh': theirs,
  'wide-rays': () => hitsIn(set.cast('wide-rays', met).objects),
  'BoxBvh.cast': castOurs,
  'three-mesh-bvh': castTheirs,
  occluders: drawWalls,
  queries: askBoxes,
};
const moving = {
  'World-move': () => same.move(),
  'InstancedMesh2-move': () => same.moveTheirs(),
  'World-move-others': () => others.move(),
  'InstancedMesh2-move-others': () => others.moveTheirs(),
};
const times = {}, answers = {}, rounds = 9, warm = 2, movedBefore = 80;
// A sample is the mean of as many calls, one after another, as take `least` ms, for both sides alike: what the processor and the
// compilers keep warm in a program that culls every frame is warm here.
function measure(rows, least, before) {
  for (const name of Object.keys(rows)) times[name] = [];
  for (let round = 0; round < rounds; ++round) {
    before(round);
    for (const [name, run] of Object.entries(rows)) {
      let calls = 0;
      const start = performance.now();
      do answers[name] = run(), ++calls;
      while (performance.now() - start < least);
      if (round >= warm) times[name].push((performance.now() - start) / calls);
    }
  }
}
measure(still, 20, (round) => existsSync(native) && round >= warm && round % 2 === 0 && runNative());
for (let frame = 0; frame < movedBefore; ++frame) same.goOn(), same.move(), same.moveTheirs();
measure(moving, 0, () => (same.goOn(), others.goOn())); // a call a frame
rmSync(folder, { recursive: true });

const beside = { 'World.cull': ['native-World.cull', 'three-intersectsBox', 'InstancedMesh2-bvh'],
  cullBoxes: ['by-hand', 'native-cullBoxes'], 'World-move': ['InstancedMesh2-move'],
  'World-move-others': ['InstancedMesh2-move-others'], 'wide-rays': ['three-mesh-bvh', 'BoxBvh.cast'], occluders: ['native-occluders'], queries: ['native-queries'] };
for (const [name, all] of Object.entries(natively)) times[`native-${name}`] = all;
times['first-cull'] = [first];
writeRows('node', times, beside, answers);
