// What users rely on beside right answers: clear refusals, memory that is given back, handles, the worker.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { test } from 'node:test';
import {
  BoxBvh, bytes, CellPvs, clipZeroToOne, Culler, cullBoxes, cullSpheres, doubles, floats, idOf, integers, noObject, noOccluder,
  OccluderMesh, OcclusionBuffer, ready, SightlineError, supported, World } from 'sightline-culling';
import { visibleSet } from 'sightline-culling/webgpu';
import { WorkerWorld } from 'sightline-culling/worker';

const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const perspective = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1.001, -1, 0, 0, -0.1001, 0];
const view = { worldToEye: identity, eyeToClip: perspective, width: 64, height: 64 };
const cube = (x, y, z, half = 1) => [x - half, y - half, z - half, x + half, y + half, z + half];
const refusal = (code, words) => (error) => {
  assert.ok(error instanceof SightlineError, String(error));
  assert.equal(error.code, code);
  assert.match(error.message, words);
  return true;
};

test('it says so before it is loaded', () => {
  assert.equal(supported, true);
  assert.throws(() => new World(), refusal('not_ready', /await ready/));
});

test('without SIMD it says so, and never loads', () => {
  const said = execFileSync(process.execPath, ['--input-type=module', '-e', `
    WebAssembly.validate = () => false;
    const { ready, supported, World } = await import('sightline-culling');
    const code = (error) => error.code + ': ' + error.message;
    console.log(supported, await ready.catch(code));
    try { new World(); } catch (error) { console.log(code(error)); }`], { encoding: 'utf8', cwd: `${import.meta.dirname}/..` });
  assert.match(said, /^false unsupported: .*no WebAssembly with SIMD.*draw without culling\nunsupported: .*draw without culling\n$/);
});

test('without SIMD a three.js scene is drawn whole, and the console says so once', () => {
  const said = execFileSync(process.execPath, ['--input-type=module', '-e', `
    WebAssembly.validate = () => false;
    console.warn = (words) => console.log('warned: ' + words);
    const { Mesh, PerspectiveCamera, Scene } = await import('three');
    const { ready, SightlineCuller } = await import('sightline-culling/three');
    const scene = new Scene().add(new Mesh()), { children } = scene;
    new SightlineCuller(scene), new SightlineCuller(new Scene());
    await ready.catch(() => {});
    for (let frame = 0; frame < 3; ++frame) {
      scene.onBeforeRender({ sortObjects: true }, scene, new PerspectiveCamera(), null);
      console.log(scene.children === children && children.length === 1);
      scene.onAfterRender({ sortObjects: true }, scene, new PerspectiveCamera());
    }`], { encoding: 'utf8', cwd: `${import.meta.dirname}/..` });
  assert.match(said, /^(warned: Sightline draws without culling: .*no WebAssembly with SIMD.*\n){2}(true\n){3}$/); // each of the two
});

test('objects in view are seen, in all layouts', async () => {
  await ready;
  const at = [[0, 0, -10], [0, 0, 10], [3, 1, -20]];
  const world = new World(), culler = new Culler();
  const handles = world.insert(Float32Array.from(at.flatMap(([x, y, z]) => cube(x, y, z))));
  assert.deepEqual([...culler.cull(world, view).ids].sort(), [0, 2]);
  assert.equal(world.size, 3);
  assert.equal(idOf(handles[2]), 2);
  world.move(handles, { data: Float64Array.from(at.flatMap((p) => [...p, 1, 1, 1])), layout: 'centre-half' });
  assert.deepEqual([...culler.cull(world, view).ids].sort(), [0, 2]);
  world.setValues(handles, Uint32Array.of(70, 80, 90));
  assert.deepEqual([...culler.cull(world, view, { valuesForIds: true }).ids].sort(), [70, 90]);
  world.setLayers(handles[0], Uint32Array.of(2));
  assert.deepEqual([...culler.cull(world, { ...view, layers: 1 }).ids], [2]);
  const both = culler.cull(world, [view, { ...view, layers: 2 }]);
  assert.deepEqual([...both.ids].map((id, i) => [id, both.masks[i]]).sort(), [[0, 3], [2, 3]]);
  world.remove(handles.subarray(0, 1));
  assert.equal(world.contains(handles[0]), false);
  assert.deepEqual([...culler.cull(world, view).ids], [2]);
  assert.deepEqual([...world.box(handles[1])], [-1, -1, 9, 1, 1, 11]);
});

test('spheres and boxes are culled flat', async () => {
  await ready;
  const out = integers(66);
  assert.equal(cullSpheres(view, Float32Array.of(0, 0, 0, 0, -10, 10, 1, 1), out), 1);
  assert.equal(out.array[0], 0);
  const small = integers(2);
  assert.throws(() => cullBoxes(view, new Float32Array(12), small), refusal('buffer_too_small', /expected/));
});

test('bad input is refused with one sentence and changes nothing', async () => {
  await ready;
  const world = new World(), culler = new Culler();
  assert.throws(() => world.insert(Float32Array.of(...cube(0, 0, 0), ...cube(NaN, 0, 0))), refusal('bad_box', /index 1/));
  assert.throws(() => world.insert(new Float32Array(7)), refusal('bad_argument', /7 numbers, expected a multiple of 6/));
  assert.throws(() => world.insert([1, 2, 3]), refusal('bad_argument', /Float32Array/));
  assert.equal(world.size, 0);
  const handles = world.insert(Float32Array.from(cube(0, 0, -5)));
  assert.throws(() => world.move(handles, new Float32Array(12)), refusal('bad_argument', /1 elements, expected 2/));
  assert.throws(() => world.remove(handles[0] + 2 ** 31), refusal('stale_handle', /./));
  for (const nonsense of [NaN, -1, 1e300, 0.5]) assert.equal(world.contains(nonsense), false);
  assert.throws(() => culler.cull(world, { ...view, eyeToClip: perspective.map(() => NaN) }), refusal('bad_view', /./));
  assert.throws(() => culler.cull(world, { ...view, width: 1.5 }), refusal('bad_view', /1 to 16384/));
  assert.throws(() => culler.cull(world, []), refusal('bad_argument', /1 to 8/));
  assert.throws(() => culler.cull(world, { ...view, occlusion: new OcclusionBuffer() }), refusal('stale_buffer', /./));
  for (const occlusion of [true, {}, { pointer: 64 }, world])
    assert.throws(() => culler.cull(world, { ...view, occlusion }), refusal('bad_argument', /expected an OcclusionBuffer/));
  for (const layers of ['all', NaN, 0.5])
    assert.throws(() => culler.cull(world, { ...view, layers }), refusal('bad_argument', /expected an integer of 32 bits/));
  // More bytes than a module can address.
  for (const make of [() => floats(2 ** 30), () => doubles(2 ** 29 + 8), () => floats(2 ** 31)])
    assert.throws(make, refusal('too_many', /no memory for/));
  for (const layers of [2 ** 40, 2 ** 32, -(2 ** 32)])
    assert.throws(() => culler.cull(world, { ...view, layers }), refusal('bad_argument', /expected an integer of 32 bits/));
  assert.equal(culler.cull(world, { ...view, layers: -1 }).ids.length, 1); // as three has them
  assert.equal(culler.cull(world, view).ids.length, 1);
  assert.throws(() => new OccluderMesh(new Float32Array(9), Uint32Array.of(0, 1, 3)), refusal('bad_mesh', /index 2/));
});

test('what is no number is no handle, and what is no size is none', async () => {
  await ready;
  const world = new World(), box = Float32Array.from(cube(0, 0, -5)), handle = world.insert(box)[0];
  assert.equal(world.handle(0), handle);
  for (const id of [2 ** 32, 0.5, NaN, -1, undefined, null, '0', []]) assert.equal(world.handle(id), undefined, String(id));
  for (const nonsense of ['0', [], null, undefined]) {
    assert.equal(world.contains(nonsense), false);
    for (const ask of ['box', 'layers', 'value'])
      assert.throws(() => world[ask](nonsense), refusal('stale_handle', new RegExp(`^${ask}: no object has this handle`)));
    assert.throws(() => world.setTriangles(nonsense, new Float32Array(9)), refusal('stale_handle', /^setTriangles/));
  }
  const bvh = new BoxBvh();
  bvh.build(box);
  for (const [columns, rows] of [[2 ** 32 + 1, 1], [1, 2 ** 32 + 1], [0.5, 1], [0, 1], [1, '1']])
    assert.throws(() => bvh.visibleSet(view, columns, rows), refusal('bad_argument', /rays, expected 1 to 2\^24/));
});

test('null is no options, and refused elsewhere', async () => {
  await ready;
  const world = new World(), culler = new Culler(), buffer = new OcclusionBuffer(), box = Float32Array.from(cube(0, 0, -5));
  const handle = world.insert(box, null)[0], mesh = new OccluderMesh(new Float32Array(9), Uint32Array.of(0, 1, 2));
  assert.equal(culler.cull(world, view, null).ids.length, 1);
  assert.throws(() => buffer.maySee(box, bytes(1)), refusal('stale_buffer', /never begun, expected begin/));
  buffer.begin(view, null);
  const origin = /an origin of undefined numbers, expected 3/;
  assert.throws(() => world.insert({ data: box, origin: null }), refusal('bad_argument', origin));
  assert.throws(() => culler.cull(world, { ...view, origin: null }), refusal('bad_view', origin));
  assert.throws(() => world.setTriangles(handle, new Float32Array(9), null), refusal('bad_argument', origin));
  assert.throws(() => buffer.drawMesh(mesh, null), refusal('bad_argument', /transform of undefined numbers, expected 16/));
  assert.throws(() => buffer.drawMesh(null, identity), refusal('bad_argument', /expected an OccluderMesh/));
  assert.equal(world.size, 1);
});

test('what was disposed of is not used', async () => {
  await ready;
  const made = [new World(), new Culler(), new OcclusionBuffer(), new BoxBvh()];
  const block = floats(6);
  for (const thing of [...made, block]) thing.dispose(), thing.dispose();
  for (const call of [(world) => world.insert(Float32Array.from(cube(0, 0, 0))), (world) => world.contains('x'), (world) => world.handle({})])
    assert.throws(() => call(made[0]), refusal('disposed', /World: used after dispose/));
  assert.throws(() => made[1].cull(new World(), view), refusal('disposed', /Culler/));
  assert.throws(() => made[2].begin(view), refusal('disposed', /OcclusionBuffer/));
  assert.throws(() => made[3].build(Float32Array.from(cube(0, 0, 0))), refusal('disposed', /BoxBvh/));
  assert.throws(() => block.array, refusal('disposed', /Block/));
});

test('arrays in the module are used where they lie, and one from before it grew is refused', async () => {
  await ready;
  const world = new World();
  const boxes = floats(6);
  boxes.array.set(cube(0, 0, -5));
  const old = boxes.array;
  world.insert(old);
  world.insert(boxes);
  const large = doubles(2 ** 25);
  assert.equal(old.length, 0);
  assert.throws(() => world.insert(old), refusal('detached', /fetch it from its Block anew/));
  assert.deepEqual([...boxes.array], cube(0, 0, -5));
  world.insert(boxes.array);
  assert.equal(world.size, 3);
  large.dispose();
});

test('1,000 rounds of making and disposing leak nothing', async () => {
  await ready;
  const round = () => {
    const world = new World(), culler = new Culler(), buffer = new OcclusionBuffer(), bvh = new BoxBvh();
    const boxes = Float32Array.from(Array.from({ length: 200 }, (_, i) => cube(i % 14, 0, -i)).flat());
    world.insert(boxes);
    culler.cull(world, view);
    buffer.begin(view), buffer.drawBoxes(boxes);
    bvh.build(boxes);
    const mesh = new OccluderMesh(Float32Array.of(0, 0, 0, 1, 0, 0, 0, 1, 0), Uint32Array.of(0, 1, 2));
    world.setOccluders(world.handle(0), world.addOccluder({ boxes: Float32Array.of(-1, -1, -1, 1, 1, 1) }));
    culler.cull(world, view, { occlusion: 'automatic' });
    assert.throws(() => world.insert(Float32Array.of(1, 0, 0, 0, 0, 0)));
    for (const thing of [world, culler, buffer, bvh, mesh]) thing.dispose();
  };
  for (let i = 0; i < 20; ++i) round();
  const probe = bytes(1);
  const size = probe.array.buffer.byteLength;
  for (let i = 0; i < 1000; ++i) round();
  assert.equal(probe.array.buffer.byteLength, size);
});

// Four million rounds: in `test.sh --full`.
test('a slot whose generations are spent is retired', { skip: !process.env.SIGHTLINE_FULL }, async () => {
  await ready;
  const world = new World(), culler = new Culler(), solid = world.addOccluder({ boxes: Float32Array.of(0, 0, 0, 1, 1, 1) });
  const box = floats(6);
  box.array.set(cube(0, 0, -5));
  let handle = world.insert(box)[0];
  const first = handle;
  for (let i = 0; i < 2 ** 22 - 1; ++i) world.remove(handle), (handle = world.insert(box)[0]);
  assert.equal(idOf(handle), idOf(first));
  assert.equal(Math.floor(handle / 2 ** 31), 2 ** 22 - 1);
  world.setOccluders(handle, solid);
  world.remove(handle);
  world.removeOccluder(solid); // nobody carries it any more
  assert.throws(() => world.setTriangles(handle, new Float32Array(9)), refusal('stale_handle', /./));
  assert.equal(world.size, 0);
  assert.equal(world.contains(handle), false);
  assert.equal(world.handle(idOf(handle)), undefined);
  assert.throws(() => world.remove(handle), refusal('stale_handle', /./));
  assert.equal(culler.cull(world, view).ids.length, 0);
  const next = world.insert(box)[0];
  assert.notEqual(idOf(next), idOf(first));
  assert.throws(() => world.remove(Float64Array.of(next, handle)), refusal('stale_handle', /./));
  assert.equal(world.contains(next), true);
});

test('what is hidden is culled, what shows is not', async () => {
  await ready;
  const buffer = new OcclusionBuffer(), world = new World(), culler = new Culler();
  world.insert(Float32Array.from([...cube(0, 0, -20), ...cube(18, 0, -20)]));
  buffer.begin(view);
  buffer.drawBoxes(Float32Array.from(cube(0, 0, -10, 3)));
  const culled = culler.cull(world, { ...view, occlusion: buffer });
  assert.deepEqual([...culled.ids], [1]);
  assert.equal(culled.culledOcclusion, 1);
  const corners = Float32Array.of(-3, -3, -5, 3, -3, -5, 0, 4, -5);
  buffer.begin(view);
  buffer.drawMesh(new OccluderMesh(corners, Uint32Array.of(0, 1, 2), 'front'), identity);
  const nearness = floats(64 * 64);
  buffer.readNearness(nearness);
  assert.ok(Math.abs(nearness.array[32 * 64 + 32] - 0.2) < 1e-3);
  const seen = bytes(1);
  buffer.maySee(Float32Array.from(cube(0, 0, -20, 0.5)), seen);
  assert.equal(seen.array[0], 0);
});

test('a buffer answers for pixel centres or for any place on the image', async () => {
  await ready;
  const buffer = new OcclusionBuffer(), seen = bytes(1);
  // Behind a wall, but for a strip narrower than half a pixel, between two centres.
  const wall = Float32Array.of(-20, -20, -11, 0.1, 20, -10), box = Float32Array.of(-1, -1, -21, 0.25, 1, -20);
  const answers = [{}, { coverage: 'centres' }, { coverage: 'area' }, { coverage: 'area', scale: 2 }].map((options) => {
    buffer.begin(view, options);
    buffer.drawBoxes(wall);
    buffer.maySee(box, seen);
    return seen.array[0];
  });
  assert.deepEqual(answers, [1, 0, 1, 1]); // any place, unless told otherwise
  assert.throws(() => buffer.begin(view, { coverage: 'samples' }), refusal('bad_argument', /samples, expected centres, area/));
  for (const scale of [0, 3, 1.5]) assert.throws(() => buffer.begin(view, { scale }), refusal('bad_argument', /./));
});

test('what objects carry hides what is behind them, where that pays', async () => {
  await ready;
  const world = new World(), culler = new Culler(), options = { occlusion: 'automatic', costs: { object: 1e6 } };
  const behind = Array.from({ length: 400 }, (_, i) => cube((i % 20) - 10, Math.floor(i / 20) - 10, -40, 0.2)).flat();
  const wall = world.insert(Float32Array.from(cube(0, 0, -20, 18)))[0];
  world.insert(Float32Array.from(behind));
  const seen = () => {
    let last;
    for (let frame = 0; frame < 40; ++frame) last = culler.cull(world, view, options);
    return last;
  };
  assert.equal(seen().ids.length, 401);
  const solid = world.addOccluder({ boxes: Float32Array.of(-18, -18, -18, 18, 18, 18) });
  world.setOccluders(wall, solid, Float32Array.of(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -20, 1));
  const culled = seen();
  assert.deepEqual([...culled.ids], [0]);
  assert.equal(culled.culledOcclusion, 400);
  assert.ok(culled.cost < 0.1 * culled.frustumCost);
  world.setOccluding(wall, false);
  assert.equal(seen().ids.length, 401);
  world.setOccluding(wall, Uint8Array.of(1));
  assert.equal(seen().ids.length, 1);
  world.setOccluders(wall, noOccluder);
  assert.equal(seen().ids.length, 401);
  world.removeOccluder(solid);
  assert.equal(world.addOccluder({ spheres: Float32Array.of(0, 0, 0, 1) }), solid);
});

test('an object is asked by the triangles that it shows', async () => {
  await ready;
  const world = new World(), culler = new Culler(), options = { occlusion: 'automatic', costs: { object: 1e6 } };
  const handles = world.insert(Float32Array.from([...cube(0, 0, -20, 8), ...cube(0, 0, -40, 30)]));
  world.setOccluders(handles[0], world.addOccluder({ boxes: Float32Array.of(-8, -8, -28, 8, 8, -12) }));
  const seen = () => Array.from({ length: 40 }, () => culler.cull(world, view, options).ids.length).at(-1);
  assert.equal(seen(), 2);
  world.setTriangles(handles[1], Float32Array.of(-3, -3, -40, 3, -3, -40, 0, 3, -40));
  assert.equal(seen(), 1);
  world.setTriangles(handles[1], new Float32Array(0));
  assert.equal(seen(), 2);
});

test('occluders that are not sound are refused and change nothing', async () => {
  await ready;
  const world = new World(), culler = new Culler(), handle = world.insert(Float32Array.from(cube(0, 0, -5)))[0];
  const triangle = { positions: Float32Array.of(0, 0, 0, 1, 0, 0, 0, 1, 0), indices: Uint32Array.of(0, 1, 2) };
  const add = (occluder) => () => world.addOccluder(occluder);
  assert.throws(add({ ...triangle, indices: Uint32Array.of(0, 1, 3) }), refusal('bad_mesh', /index 2/));
  assert.throws(add({ ...triangle, positions: [0, 0, 0] }), refusal('bad_argument', /positions: expected a Float32Array/));
  assert.throws(add({ ...triangle, sides: Uint8Array.of(2) }), refusal('bad_argument', /neither 0 .both. nor 1 .front./));
  assert.throws(add({ ...triangle, solidTriangles: 2 }), refusal('bad_argument', /more solid triangles/));
  assert.throws(add({ ...triangle, solidTriangles: 0.5 }), refusal('bad_argument', /0\.5 solid triangles/));
  assert.throws(add({ boxes: new Float32Array(7) }), refusal('bad_argument', /7 numbers of boxes, expected a multiple of 6/));
  assert.throws(add({ boxes: Float32Array.of(0, 0, 0, 1, 1, NaN) }), refusal('bad_box', /index 0/));
  assert.throws(add({ spheres: Float32Array.of(0, 0, 0, -1) }), refusal('bad_box', /index 0/));
  const solid = world.addOccluder(triangle);
  assert.throws(() => world.setOccluders(handle, solid + 1), refusal('bad_argument', /names no occluder/));
  assert.throws(() => world.setOccluders(handle, -1), refusal('bad_argument', /expected what addOccluder returned/));
  assert.throws(() => world.setOccluders(handle, solid, new Float32Array(16)), refusal('bad_argument', /not affine/));
  assert.throws(() => world.setOccluders(handle, solid, new Float32Array(15)), refusal('bad_argument', /15 elements, expected 16/));
  assert.throws(() => world.setOccluders(handle, solid, undefined, [0, NaN, 0]), refusal('bad_argument', /out of reach/));
  assert.throws(() => world.setOccluders(handle + 2 ** 31, solid), refusal('stale_handle', /./));
  world.setOccluders(handle, solid);
  assert.throws(() => world.removeOccluder(solid), refusal('bad_argument', /still carries/));
  assert.throws(() => world.removeOccluder(solid + 1), refusal('bad_argument', /no occluder of this name/));
  assert.throws(() => world.setOccluding(handle, Uint8Array.of(2)), refusal('bad_argument', /neither 0 nor 1/));
  assert.throws(() => world.setTriangles(handle, new Float32Array(6)), refusal('bad_mesh', /three points/));
  assert.throws(() => world.setTriangles(handle, new Float32Array(5)), refusal('bad_argument', /5 numbers of corners/));
  const options = { occlusion: 'automatic' };
  assert.throws(() => culler.cull(world, view, { occlusion: 'some' }), refusal('bad_argument', /expected none or automatic/));
  assert.throws(() => culler.cull(world, view, { ...options, costs: { node: NaN } }), refusal('bad_argument', /cost is negative/));
  assert.throws(() => culler.cull(world, view, { ...options, costs: { cube: 1 } }), refusal('bad_argument', /cube is no option/));
  const buffer = new OcclusionBuffer();
  buffer.begin(view);
  assert.throws(() => culler.cull(world, { ...view, occlusion: buffer }, options), refusal('bad_argument', /brings a buffer/));
  assert.throws(() => culler.reportFrameTime(-1), refusal('bad_argument', /time is out of range/));
  assert.equal(culler.cull(world, view, options).ids.length, 1);
});

test('rays meet the nearest box', async () => {
  await ready;
  const bvh = new BoxBvh(), objects = integers(2), distances = floats(2);
  bvh.build(Float32Array.from([...cube(0, 0, -20), ...cube(0, 0, -10)]));
  bvh.cast(Float32Array.of(0, 0, 0, 0, 0, -1, Infinity, 0, 0, 0, 0, 1, 0, Infinity), objects, distances);
  assert.deepEqual([...objects.array], [1, noObject]);
  assert.deepEqual([...distances.array], [9, -1]);
  assert.deepEqual([...bvh.visibleSet(view, 16, 16)], [1]);
  assert.throws(() => bvh.refit(new Float32Array(6)), refusal('bad_argument', /1 boxes, expected 2/));
});

test('visible sets are asked by cell', () => {
  const arrays = {
    bounds: [0, 0, 0, 2, 1, 1], counts: [2, 1, 1], objects: 3, open: Uint8Array.of(1, 0),
    first: Uint32Array.of(0, 2, 2), visible: Uint32Array.of(0, 2) };
  const pvs = new CellPvs(arrays);
  assert.equal(pvs.cellAt(0.5, 0.5, 0.5), 0);
  assert.equal(pvs.cellAt(1.5, 0.5, 0.5), undefined);
  assert.equal(pvs.cellAt(3, 0.5, 0.5), undefined);
  assert.deepEqual([...pvs.seenFrom(0)], [0, 2]);
  assert.throws(() => new CellPvs({ ...arrays, visible: Uint32Array.of(2, 0) }), refusal('bad_argument', /cell 0/));
});

test('what a call writes has to lie in the module', () => {
  const buffer = new OcclusionBuffer(), bvh = new BoxBvh(), boxes = Float32Array.from(cube(0, 0, -5));
  buffer.begin(view), bvh.build(boxes);
  const needed = refusal('bad_argument', /expected a Block/), ray = Float32Array.of(0, 0, 0, 0, 0, -1, Infinity);
  assert.throws(() => buffer.readNearness(new Float32Array(64 * 64)), needed);
  assert.throws(() => buffer.maySee(boxes, new Uint8Array(1)), needed);
  assert.throws(() => bvh.cast(ray, new Uint32Array(1), new Float32Array(1)), needed);
  assert.throws(() => buffer.begin(view, { scale: 2 ** 32 + 1 }), SightlineError);
  for (const each of [buffer, bvh, new BoxBvh()]) each.dispose(); // the module is as it was
});

test('arrays of visible sets and hits are checked', () => {
  for (const arrays of [null, {}, { bounds: [0, 0, 0, 1, 1, 1], counts: [1, 1, 1], open: [1], first: [0, 0], visible: [] }])
    assert.throws(() => new CellPvs(arrays), refusal('bad_argument', /^CellPvs: expected open/));
  const arrays = { bounds: [0, 0, 0, 1, 1, 1], counts: [1, 1, 1], open: Uint8Array.of(1), first: Uint32Array.of(0, 0), visible: new Uint32Array(0) };
  for (const objects of [undefined, NaN, -1]) assert.throws(() => new CellPvs({ ...arrays, objects }), refusal('bad_argument', /objects/));
  const hits = { objects: Uint32Array.of(0), distances: Float32Array.of(1) };
  for (const objects of [-1, Infinity, new Date()]) assert.throws(() => visibleSet(hits, objects), refusal('bad_argument', /objects/));
  assert.throws(() => visibleSet(null, 1), refusal('bad_argument', /hits/));
  hits.objects = Uint32Array.of(0xffffffff, 4); // the first ray meets nothing
  assert.throws(() => visibleSet(hits, 4), refusal('bad_argument', /hits of object 4, expected those of 4 objects/));
  assert.deepEqual(visibleSet(hits, 5), Uint32Array.of(4));
  assert.throws(() => new OccluderMesh(new Float32Array(9), Uint32Array.of(0, 1, 2), 'back'), refusal('bad_argument', /sides/));
});

test('clip depth of WebGL becomes 0 to 1', () => {
  const gl = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -3, -1, 0, 0, -4, 0]; // near 1, far 2
  const made = clipZeroToOne(gl);
  const depth = (z) => (made[10] * z + made[14]) / (made[11] * z + made[15]);
  assert.equal(depth(-1), 0);
  assert.equal(depth(-2), 1);
});

test('a worker culls', async () => {
  const worker = await WorkerWorld.start();
  const handles = await worker.insert(Float32Array.from([...cube(0, 0, -5), ...cube(0, 0, 5)]));
  assert.equal(handles.length, 2);
  assert.deepEqual([...(await worker.cull(view)).ids], [0]);
  await assert.rejects(worker.insert(Float32Array.of(1, 0, 0, 0, 0, 0)), refusal('bad_box', /./));
  await assert.rejects(worker.insert(() => {}), refusal('bad_argument', /cannot be posted/));
  const pending = worker.cull(view);
  worker.dispose();
  await assert.rejects(pending, refusal('disposed', /./));
  await assert.rejects(worker.cull(view), refusal('disposed', /used after dispose/)); // and does not throw
});
