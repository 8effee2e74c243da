// node bench/bench.mjs [COUNT]: how long culling a million boxes takes in Node, of which a tenth is in view, and casting
// 10,000 rays, beside three.js and its libraries: medians, interleaved, in one process. Answers are compared first.
import { InstancedMesh2 } from '@three.ez/instanced-mesh';
import * as THREE from 'three';
import { MeshBVH } from 'three-mesh-bvh';
import { BoxBvh, Culler, cullBoxes, floats, integers, ready, World } from 'sightline-culling';

const started = performance.now();
await ready;
new Culler().cull(new World(), { worldToEye: new THREE.Matrix4().elements, eyeToClip: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0,
  -0.1, 0], width: 1, height: 1 });
console.log(`first cull after ${(performance.now() - started).toFixed(1)} ms`);

const count = Number(process.argv[2] ?? 1e6), side = 4000;
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
const camera = new THREE.PerspectiveCamera(50, 16 / 9, 0.1, 1600);
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

const hundredth = count / 100, moved = new Float64Array(hundredth), to = new Float32Array(6 * hundredth);
const move = () => {
  for (let k = 0; k < hundredth; ++k) {
    const i = k * 100;
    for (const axis of [0, 3]) boxes.array[6 * i + axis] += 0.125;
    three[i].min.x += 0.125, (three[i].max.x += 0.125);
    moved[k] = handles[i], to.set(boxes.array.subarray(6 * i, 6 * i + 6), 6 * k);
  }
};
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
const meshBvh = new MeshBVH(triangles), threeRays = [];
for (let r = 0; r < rays; ++r) {
  const direction = new THREE.Vector3(((r % 100) - 49.5) / 60, (Math.floor(r / 100) - 49.5) / 100, -1);
  threeRays.push(new THREE.Ray(camera.position.clone(), direction.normalize()));
  rayData.array.set([...camera.position, ...direction, Infinity], 7 * r);
}
const castTheirs = () => {
  let hits = 0;
  for (const ray of threeRays) if (meshBvh.raycastFirst(ray, THREE.DoubleSide)) ++hits;
  return hits;
};
const castOurs = () => {
  bvh.cast(rayData, objects, distances);
  return objects.array.reduce((hits, object) => hits + (object === 0xffffffff ? 0 : 1), 0);
};

const rows = {
  'World.cull': () => culler.cull(world, view).ids.length,
  'cullBoxes, columns': () => cullBoxes(view, { data: columns, layout: 'columns' }, out),
  'three: Frustum.intersectsBox': three_loop,
  'InstancedMesh2: BVH': theirs,
  'World: move 1 % and cull': () => (move(), world.move(moved, to), culler.cull(world, view).ids.length),
  'InstancedMesh2: move 1 % and cull': () => {
    for (let k = 0; k < hundredth; ++k) place(k * 100), mesh.bvh.move(k * 100);
    return theirs();
  },
  'BoxBvh.cast, 10,000 rays': castOurs,
  'three-mesh-bvh: raycastFirst, 10,000 rays': castTheirs,
};
const times = Object.fromEntries(Object.keys(rows).map((name) => [name, []]));
const answers = {};
for (let round = 0; round < 12; ++round) {
  for (const [name, run] of Object.entries(rows)) {
    const start = performance.now();
    answers[name] = run();
    if (round >= 3) times[name].push(performance.now() - start);
  }
}
for (const [name, all] of Object.entries(times)) {
  all.sort((a, b) => a - b);
  console.log(`${name.padEnd(44)} ${all[Math.floor(all.length / 2)].toFixed(3).padStart(9)} ms ` +
    `(${all[0].toFixed(3)} to ${all.at(-1).toFixed(3)}), ${answers[name]}`);
}
