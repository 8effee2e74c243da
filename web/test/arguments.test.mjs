// Arguments that no type allows and JavaScript does: each is refused with one sentence, and nothing has changed then.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import * as THREE from 'three';
import {
  Block, BoxBvh, bytes, CellPvs, clipZeroToOne, Culler, cullBoxes, cullSpheres, doubles, floats, idOf, integers, OccluderMesh,
  OcclusionBuffer, ready, SightlineError, World } from 'sightline-culling';
import { SightlineCuller } from 'sightline-culling/three';
import { SightlineTilesPlugin } from 'sightline-culling/three-tiles';
import { GpuRays, RaySet, visibleSet } from 'sightline-culling/webgpu';
import { WorkerWorld } from 'sightline-culling/worker';

await ready;
const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const perspective = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1.001, -1, 0, 0, -0.1001, 0];
const view = { worldToEye: identity, eyeToClip: perspective, width: 64, height: 64 };
const box = Float32Array.of(-1, -1, -6, 1, 1, -4), triangle = [new Float32Array(9), Uint32Array.of(0, 1, 2)];
const cells = { bounds: [0, 0, 0, 1, 1, 1], counts: [1, 1, 1], objects: 0, open: Uint8Array.of(1), first: Uint32Array.of(0, 0), visible: new Uint32Array(0) };
const world = new World(), culler = new Culler(), buffer = new OcclusionBuffer(), bvh = new BoxBvh(), rays = new RaySet(box);
const handle = world.insert(box)[0], mesh = new OccluderMesh(...triangle), pvs = new CellPvs(cells);
buffer.begin(view), bvh.build(box), rays.aim(view, 2, 2);

// What it is to be told: what, and what was expected.
const isRefusal = (error) => {
  assert.ok(error instanceof SightlineError, error.stack);
  assert.match(error.message, /^[A-Za-z]+(\.start)?: .*(expected|used after|no memory|has this handle|names no)/);
  return true;
};

// Each takes a value where a number, an array or a choice is expected.
const entrances = {
  idOf: (x) => idOf(x),
  'Block: length': (x) => floats(x),
  'Block: kind': (x) => new Block(x, 4),
  'clipZeroToOne: numbers': (x) => clipZeroToOne([...identity.slice(1), x]),
  'clipZeroToOne: projection': (x) => clipZeroToOne(x),
  'insert: boxes': (x) => world.insert(x),
  'insert: data': (x) => world.insert({ data: x }),
  'insert: layout': (x) => world.insert({ data: box, layout: x }),
  'insert: stride': (x) => world.insert({ data: box, stride: x }),
  'insert: origin': (x) => world.insert({ data: box, origin: [0, x, 0] }),
  'insert: origins': (x) => world.insert({ data: box, origin: x }),
  'insert: layers': (x) => world.insert(box, { layers: x }),
  'move: handles': (x) => world.move(x, box),
  'remove: handles': (x) => world.remove(x),
  'setLayers: layers': (x) => world.setLayers(handle, x),
  'cull: world': (x) => culler.cull(x, view),
  'cull: view': (x) => culler.cull(world, x),
  'cull: numbers': (x) => culler.cull(world, { ...view, worldToEye: [...identity.slice(1), x] }),
  'cull: matrix': (x) => culler.cull(world, { ...view, eyeToClip: x }),
  'cull: width': (x) => culler.cull(world, { ...view, width: x }),
  'cull: origin': (x) => culler.cull(world, { ...view, origin: [x, 0, 0] }),
  'cull: layers': (x) => culler.cull(world, { ...view, layers: x }),
  'cull: minArea': (x) => culler.cull(world, { ...view, minArea: x }),
  'cull: buffer': (x) => culler.cull(world, { ...view, occlusion: x }),
  'cull: occlusion': (x) => culler.cull(world, view, { occlusion: x }),
  'cull: cost': (x) => culler.cull(world, view, { occlusion: 'automatic', costs: { node: x } }),
  reportFrameTime: (x) => culler.reportFrameTime(x),
  'cullBoxes: out': (x) => cullBoxes(view, box, x),
  'cullSpheres: spheres': (x) => cullSpheres(view, x, integers(68)),
  'OccluderMesh: positions': (x) => new OccluderMesh(x, triangle[1]),
  'OccluderMesh: sides': (x) => new OccluderMesh(...triangle, x),
  'begin: coverage': (x) => buffer.begin(view, { coverage: x }),
  'begin: scale': (x) => buffer.begin(view, { scale: x }),
  'drawSpheres: spheres': (x) => buffer.drawSpheres(x),
  'drawMesh: mesh': (x) => buffer.drawMesh(x, identity),
  'drawMesh: numbers': (x) => buffer.drawMesh(mesh, [...identity.slice(1), x]),
  'drawMesh: transform': (x) => buffer.drawMesh(mesh, x),
  'maySee: out': (x) => buffer.maySee(box, x),
  'readNearness: out': (x) => buffer.readNearness(x),
  'addOccluder: boxes': (x) => world.addOccluder({ boxes: x }),
  'addOccluder: solidTriangles': (x) => world.addOccluder({ positions: triangle[0], indices: triangle[1], solidTriangles: x }),
  'setOccluders: occluder': (x) => world.setOccluders(handle, x),
  'setOccluders: origin': (x) => world.setOccluders(handle, 0xffffffff, undefined, [x, 0, 0]),
  'setOccluding: on': (x) => world.setOccluding(handle, x),
  'removeOccluder: name': (x) => world.removeOccluder(x),
  'setTriangles: handle': (x) => world.setTriangles(x, triangle[0]),
  'setTriangles: corners': (x) => world.setTriangles(handle, x),
  'setTriangles: origin': (x) => world.setTriangles(handle, triangle[0], [x, 0, 0]),
  'setTriangles: sides': (x) => world.setTriangles(handle, triangle[0], [0, 0, 0], x),
  'BoxBvh: boxes': (x) => bvh.build(x),
  'BoxBvh.cast: rays': (x) => bvh.cast(x, integers(1), floats(1)),
  'BoxBvh.visibleSet: columns': (x) => bvh.visibleSet(view, x, 1),
  'CellPvs: arrays': (x) => new CellPvs(x),
  'CellPvs: bounds': (x) => new CellPvs({ ...cells, bounds: [x, 0, 0, 1, 1, 1] }),
  'CellPvs: counts': (x) => new CellPvs({ ...cells, counts: [x, 1, 1] }),
  'CellPvs: objects': (x) => new CellPvs({ ...cells, objects: x }),
  cellAt: (x) => pvs.cellAt(0.5, x, 0.5),
  seenFrom: (x) => pvs.seenFrom(x),
  'RaySet: boxes': (x) => new RaySet(x),
  'RaySet.aim: columns': (x) => rays.aim(view, x, 1),
  'RaySet.aim: origin': (x) => rays.aim({ ...view, origin: [x, 0, 0] }, 1, 1),
  'RaySet.cast: method': (x) => rays.cast(x),
  'visibleSet: hits': (x) => visibleSet(x, 1),
  'visibleSet: objects': (x) => visibleSet({ objects: new Uint32Array(1) }, x),
  'SightlineCuller: scene': (x) => new SightlineCuller(x),
  'SightlineCuller: bufferWidth': (x) => new SightlineCuller(new THREE.Scene(), { bufferWidth: x }),
  'SightlineTilesPlugin: mostTriangles': (x) => new SightlineTilesPlugin({ mostTriangles: x }),
};
const revoked = () => {
  const { proxy, revoke } = Proxy.revocable({}, {});
  return revoke(), proxy;
};
const values = {
  'a BigInt': () => 6n, 'a symbol': () => Symbol('six'), 'an object without words': () => Object.create(null), 'a function': () => () => 6,
  'a text': () => '6', 'a Proxy of a typed array': () => new Proxy(new Float32Array(6), {}), 'a Proxy of a Block': () => new Proxy(floats(6), {}),
  'what only claims to be one': () => Object.create(Float32Array.prototype), 'a revoked Proxy': revoked,
};

test('what is no number, array or choice is refused with a sentence at every entrance', () => {
  for (const [entrance, call] of Object.entries(entrances)) {
    for (const [name, make] of Object.entries(values)) {
      const value = make();
      try {
        assert.throws(() => call(value), isRefusal);
      } catch (error) {
        assert.fail(`${entrance} given ${name}: ${error.message}`);
      }
    }
  }
  assert.equal(world.size, 1);
  assert.equal(culler.cull(world, view).ids.length, 1);
});

test('null is no options of a culler for three.js and of its peers', async () => {
  new SightlineCuller(new THREE.Scene(), null).dispose();
  new SightlineTilesPlugin(null).dispose();
  await assert.rejects(GpuRays.start(null), isRefusal); // without WebGPU
  await assert.rejects(GpuRays.start({ device: {} }), isRefusal);
  await assert.rejects(GpuRays.start({ devise: {} }), /devise is no option, expected an object of device/);
});

test('a Proxy of what the package makes is refused, as of a page\'s reactive state', async (given) => {
  const block = floats(6), wrap = (it) => new Proxy(it, {}), worker = await WorkerWorld.start();
  given.after(() => worker.dispose()); // or its thread would keep this process
  const calls = [
    () => wrap(world).insert(box), () => wrap(world).setLayers(handle, Uint32Array.of(1)), () => wrap(world).size, () => wrap(world).dispose(),
    () => wrap(culler).cull(world, view), () => wrap(culler).dispose(), () => culler.cull(wrap(world), view),
    () => culler.cull(world, { ...view, occlusion: wrap(buffer) }), () => wrap(buffer).begin(view), () => wrap(buffer).maySee(box, bytes(1)),
    () => buffer.drawMesh(wrap(mesh), identity), () => wrap(bvh).build(box), () => wrap(bvh).refit(box), () => wrap(rays).cast('toca'),
    () => wrap(pvs).cellAt(0.5, 0.5, 0.5), () => wrap(pvs).seenFrom(0), () => wrap(block).array, () => wrap(block).dispose(),
    () => Object.create(World.prototype).size];
  for (const call of calls)
    assert.throws(call, (error) => isRefusal(error) && /a Proxy or a copy of it, expected the object itself/.test(error.message), String(call));
  await assert.rejects(async () => wrap(worker).cull(view), isRefusal);
  assert.throws(() => wrap(worker).dispose(), isRefusal);
});

test('a method that was taken off its object is refused, and the module goes on', async () => {
  const ray = Float32Array.of(0, 0, 0, 0, 0, -1, Infinity), one = Uint32Array.of(1);
  const methods = new Map([
    [world, { insert: [box], move: [handle, box], remove: [handle], setLayers: [handle, one], setValues: [handle, one], contains: [handle],
      handle: [0], box: [handle], layers: [handle], value: [handle], addOccluder: [{ boxes: box }], removeOccluder: [0],
      setOccluders: [handle, 0], setOccluding: [handle, true], setTriangles: [handle, new Float32Array(9)], dispose: [] }],
    [culler, { cull: [world, view], reportFrameTime: [1e6], dispose: [] }],
    [buffer, { begin: [view], drawBoxes: [box], drawSpheres: [new Float32Array(4)], drawMesh: [mesh, identity], maySee: [box, bytes(1)],
      readNearness: [floats(64 * 64)], dispose: [] }],
    [bvh, { build: [box], refit: [box], cast: [ray, integers(1), floats(1)], visibleSet: [view, 2, 2], dispose: [] }],
    [rays, { update: [box], aim: [view, 2, 2], cast: ['toca', { objects: new Uint32Array(4), distances: new Float32Array(4) }] }],
    [pvs, { cellAt: [0.5, 0.5, 0.5], seenFrom: [0] }], [floats(6), { dispose: [] }], [mesh, { dispose: [] }]]);
  for (const [it, calls] of methods) {
    for (const [name, given] of Object.entries(calls)) {
      // Another kind's pointer would be as wrong as none.
      for (const self of [undefined, {}, { [name]: it[name] }, ...(name === 'dispose' ? [] : [it === bvh ? rays : bvh])])
        assert.throws(() => it[name].call(self, ...given), /a Proxy or a copy of it, expected the object itself/, `${name} of ${self}`);
    }
  }
  for (const name of ['size', 'idLimit'])
    assert.throws(() => Object.getOwnPropertyDescriptor(Object.getPrototypeOf(World.prototype), name).get.call(bvh), isRefusal);
  for (const call of [WorkerWorld.prototype.insert, WorkerWorld.prototype.cull]) await assert.rejects(async () => call(box), isRefusal);
  await assert.rejects(async () => (0, GpuRays.prototype.cast)(rays, 'saa'), isRefusal);
  assert.throws(() => GpuRays.prototype.dispose.call({}), isRefusal);
  assert.equal(world.size, 1);
});

test('what is no handle has no id', () => {
  assert.equal(idOf(2 ** 53 - 1), 2 ** 31 - 1);
  for (const nonsense of [NaN, -1, 0.5, Infinity, 2 ** 53]) assert.throws(() => idOf(nonsense), /^SightlineError: idOf: .*, expected a handle$/);
});

test('cells without extent in single precision, and without end, are refused, and what was transferred since', () => {
  for (const [least, most] of [[1, 1 + 1e-9], [0, 1e-60], [0, Infinity], [-Infinity, 0], [0, 1e39], [NaN, 1]])
    assert.throws(() => new CellPvs({ ...cells, bounds: [least, 0, 0, most, 1, 1] }), /bounds without extent/, `${least} to ${most}`);
  for (const name of ['open', 'first', 'visible']) {
    const arrays = { ...cells, objects: 1, open: Uint8Array.of(1), first: Uint32Array.of(0, 1), visible: Uint32Array.of(0) }, set = new CellPvs(arrays);
    structuredClone(arrays[name], { transfer: [arrays[name].buffer] });
    for (const call of [() => set.seenFrom(0), () => set.cellAt(0.5, 0.5, 0.5)])
      assert.throws(call, (error) => error.code === 'detached' && isRefusal(error));
  }
});

test('a stride beyond memory and an array that was transferred are refused for what they are', () => {
  for (const stride of [2 ** 30, 2 ** 29, 2 ** 28 + 1])
    assert.throws(() => world.insert({ data: box, stride }), /a stride of \d+, expected an integer from 6 to 2\^28/);
  const gone = box.slice();
  structuredClone(gone, { transfer: [gone.buffer] });
  assert.throws(() => world.insert(gone), (error) => error.code === 'detached' && /transferred, or from before the memory grew/.test(error.message));
});

test('a view of a buffer that was shrunk is refused as what was transferred, where a getter of the same call shrinks it, too', () => {
  const shrinking = (numbers, whole = false) => {
    const { byteLength, length, constructor: Kind } = numbers, own = new ArrayBuffer(byteLength, { maxByteLength: byteLength });
    const array = whole ? new Kind(own) : new Kind(own, 0, length);
    return array.set(numbers), { array, shrink: (to = 0) => own.resize(to) };
  };
  const gone = (call) => assert.throws(call, (error) => error instanceof SightlineError && error.code === 'detached', String(call));
  const other = new World(), two = Float32Array.of(...box, ...box), made = other.insert(two), occluder = other.addOccluder({ boxes: box });
  const later = (shrink) => Object.defineProperty([0, 0, 0], 1, { get: () => (shrink(), 0) }); // an origin
  const calls = [
    [two, (x) => other.insert(x)], [two, (x) => other.insert({ data: x })], [two, (x) => other.move(made, x)], [made, (x) => other.move(x, two)],
    [made, (x) => other.remove(x)], [made, (x) => other.setLayers(x, Uint32Array.of(1, 1))], [Uint32Array.of(1, 1), (x) => other.setLayers(made, x)],
    [Uint32Array.of(1, 1), (x) => other.insert(two, { layers: x })], [two, (x) => other.addOccluder({ boxes: x })], [made, (x) => other.setOccluders(x, occluder)],
    [made, (x) => other.setOccluding(x, true)], [new Float32Array(9), (x) => other.setTriangles(made[0], x)], [two, (x) => buffer.drawBoxes(x)],
    [new Float32Array(4), (x) => buffer.drawSpheres(x)], [two, (x) => bvh.build(x)], [two, (x) => rays.update(x)], [two, (x) => cullBoxes(view, x, integers(66))],
    [Uint32Array.of(0, 0), (x) => visibleSet({ objects: x }, 1)], [new Float32Array(9), (x) => new OccluderMesh(x, triangle[1])], [triangle[1], (x) => new OccluderMesh(triangle[0], x)]];
  for (const [numbers, call] of calls) {
    const { array, shrink } = shrinking(numbers);
    gone(() => (shrink(), call(array)));
  }
  // By a getter, after it was counted.
  const among = (numbers, call) => {
    for (const [whole, to] of [[false, 0], [true, 0], [true, 8]]) {
      const { array, shrink } = shrinking(numbers, whole);
      gone(() => call(array, () => shrink(to)));
    }
  };
  among(two, (x, shrink) => other.insert(x, { get layers() { return shrink(); } }));
  among(made, (x, shrink) => other.setOccluders(x, occluder, undefined, later(shrink)));
  among(new Float32Array(32), (x, shrink) => other.setOccluders(made, occluder, x, later(shrink)));
  const { array, shrink } = shrinking(new Float32Array(9));
  gone(() => other.setTriangles(made[0], array, later(shrink)));
  assert.deepEqual([other.size, world.size], [2, 1]);
  // One that follows its buffer is shorter, and good.
  const follows = shrinking(Float32Array.of(...two, ...two), true);
  follows.shrink(48);
  assert.equal(other.insert(follows.array).length, 2);
  follows.shrink();
  assert.equal(other.insert(follows.array).length, 0);
  for (const whole of [false, true]) {
    const first = shrinking(Uint32Array.of(0, 1), whole), set = new CellPvs({ ...cells, objects: 5, first: first.array, visible: Uint32Array.of(2) });
    assert.deepEqual([...set.seenFrom(0)], [2]);
    first.shrink();
    gone(() => set.seenFrom(0));
  }
  bvh.build(box), rays.update(box);
});

test('lengths and numbers of objects that have no end cost no time', () => {
  const endless = [];
  endless.length = 3e7;
  let read = 0;
  const claiming = (length) => new Proxy([view], { get: (it, name) => (++read, name === 'length' ? length : it[name]) });
  for (const [views, words] of [[endless, /30000000 views, expected 1 to 8/], [claiming(4e9), /4000000000 views/], [claiming(0.5), /0.5 views/],
    [claiming({ valueOf: () => 1 }), /\(object\) views/], [[], /0 views/], [Array(9).fill(view), /9 views/], [[[view]], /worldToEye of undefined numbers/],
    [new Array(1), /worldToEye of undefined numbers/]])
    assert.throws(() => culler.cull(world, views), (error) => isRefusal(error) && words.test(error.message));
  assert.equal(read, 3); // their lengths
  assert.deepEqual([...culler.cull(world, claiming(1)).ids], [0]);
  for (const [objects, seen] of [[[], []], [[70, 0xffffffff, 5, 70, 31, 32], [5, 31, 32, 70]], [[0xffffffff], []]])
    assert.deepEqual([...visibleSet({ objects: Uint32Array.from(objects) }, 2 ** 31)], seen);
  assert.throws(() => visibleSet({ objects: Uint32Array.of(2 ** 31) }, 2 ** 31), isRefusal);
});

test('what a getter throws while it is read is told as one refusal, whatever kind of error it is', () => {
  for (const Kind of [TypeError, RangeError]) {
    const given = doing(view, 'width', () => { throw new Kind('mine'); });
    assert.throws(() => culler.cull(world, given), (error) => isRefusal(error) && /cannot be read \(mine\)/.test(error.message));
  }
  assert.throws(() => culler.cull(world, doing(view, 'width', () => { throw new Error('mine'); })), /^Error: mine$/); // the caller's own
});

test('what is started is not made by new', () => {
  for (const make of [() => new WorkerWorld(), () => new GpuRays()])
    assert.throws(make, (error) => isRefusal(error) && /made by `new`, expected `await/.test(error.message));
});

test('what stands on an array as its length, and a length that is written, have no call read or write beyond', () => {
  const out = integers(65), beyond = integers(5000), many = Float32Array.from({ length: 24000 }, (_, i) => box[i % 6]);
  beyond.array.fill(7);
  for (const [name, value] of [['length', 100000], ['kind', Float64Array], ['pointer', 64]]) {
    assert.throws(() => { out[name] = value; }, TypeError);
    assert.throws(() => Object.defineProperty(out, name, { value }), TypeError);
  }
  assert.throws(() => cullBoxes(view, many, out), (error) => error.code === 'buffer_too_small');
  assert.ok(beyond.array.every((number) => number === 7));
  const long = (array) => Object.defineProperty(array, 'length', { value: 60_000_000 });
  const other = new World(), [made] = other.insert(long(box.slice())), seen = integers(66);
  other.move(made, long(box.slice())), other.setLayers(made, long(Uint32Array.of(1))), other.setOccluding(long(Float64Array.of(made)), true);
  other.addOccluder({ boxes: long(box.slice()) }), other.setTriangles(made, long(new Float32Array(9)));
  assert.equal(cullSpheres(view, long(Float32Array.of(0, 0, -5, 1)), seen), 1);
  assert.equal(cullBoxes(view, long(box.slice()), seen), 1);
  buffer.drawSpheres(long(Float32Array.of(0, 0, -5, 1))), new OccluderMesh(long(new Float32Array(9)), long(Uint32Array.of(0, 1, 2)));
  bvh.cast(long(Float32Array.of(0, 0, 0, 0, 0, -1, Infinity)), integers(1), floats(1)), rays.update(long(box.slice())), rays.aim(view, 2, 2);
  other.remove(long(Float64Array.of(made)));
  assert.equal(other.size, 0);
  assert.equal(rays.size, 1);
});

test('a misspelt option, and what is no options, are refused', () => {
  const none = (call, words) => assert.throws(call, (error) => isRefusal(error) && words.test(error.message), String(call));
  for (const given of ['area', 5, true, [], new Float32Array(0), () => 6]) {
    for (const call of [() => buffer.begin(view, given), () => culler.cull(world, view, given), () => world.insert(box, given),
      () => world.addOccluder(given), () => culler.cull(world, view, { costs: given })]) none(call, /is no option, expected an object of [a-z]/);
  }
  none(() => buffer.begin(view, { coverages: 'area' }), /^begin: coverages is no option, expected an object of coverage, scale$/);
  none(() => culler.cull(world, view, { oclusion: 'automatic' }), /oclusion is no option/);
  none(() => culler.cull(world, view, { valuesForIds: 'yes' }), /yes, expected true or false/);
  none(() => culler.cull(world, view, { costs: { cube: 1 } }), /cube is no option, expected an object of object, node/);
  none(() => culler.cull(world, view, { costs: { node: '1' } }), /1 for node/);
  none(() => world.insert(box, { layer: Uint32Array.of(1) }), /layer is no option/);
  none(() => world.insert({ data: box, layuot: 'columns' }), /layuot is no option/);
  none(() => world.addOccluder({ box }), /box is no option/);
  for (const given of [null, undefined, {}, { positions: triangle[0] }, { indices: triangle[1] }, { sides: new Uint8Array(1) },
    { boxes: box, sides: new Uint8Array(1) }, { solidTriangles: 0 }]) none(() => world.addOccluder(given), /expected positions with indices/);
  assert.equal(world.size, 1);
});

// An object whose named property is read by way of a getter that does something first.
const doing = (it, name, does) => Object.defineProperty({ ...it }, name, { enumerable: true, get: () => (does(), it[name]) });

// Takes what is free, so that what needs much has the memory grow.
function hoard() {
  for (let size = 2 ** 20; size >= 2 ** 12; size >>= 1)
    for (const { buffer: now } = bytes(1).array; bytes(size).array.buffer === now;);
}

test('what lies in the module is taken where the call itself has the memory grow', () => {
  const own = integers(3), ball = floats(4), cube = floats(6), seen = integers(66);
  own.array.set([0, 1, 2]), ball.array.set([0, 0, -5, 1]), cube.array.set(box);
  let before = own.array.buffer;
  world.addOccluder({ positions: new Float32Array(3 * 4e6), indices: own.array });
  assert.notEqual(own.array.buffer, before);
  for (const call of [() => cullSpheres(view, ball.array, seen), () => cullBoxes(view, cube.array, seen)]) {
    hoard();
    // There is less and less room, until there is none for what the call needs beside.
    for (before = own.array.buffer; assert.equal(call(), 1), own.array.buffer === before; before = own.array.buffer) bytes(64);
  }
});

test('a getter that has the memory grow finds nothing half written', () => {
  let grown = 0;
  const kept = [], grow = () => {
    const before = kept[0]?.array.buffer ?? bytes(1).array.buffer;
    for (kept.push(bytes(1)); kept[0].array.buffer === before;) kept.push(doubles(2 ** 20));
    for (const block of kept.splice(0)) block.dispose();
    ++grown;
  };
  hoard();
  const lately = Array.from({ length: 16 }, (_, i) => identity[i]);
  Object.defineProperty(lately, 7, { enumerable: true, get: () => (grow(), 0) });
  for (const name of ['eyeToClip', 'width', 'origin', 'layers', 'minArea'])
    assert.deepEqual([...culler.cull(world, doing({ origin: [0, 0, 0], layers: 1, minArea: 0, ...view }, name, grow)).ids], [0], name);
  assert.deepEqual([...culler.cull(world, { ...view, worldToEye: lately }).ids], [0]);
  assert.deepEqual([...culler.cull(world, view, { occlusion: 'automatic', costs: doing({ node: 10 }, 'node', grow) }).ids], [0]);
  assert.equal(cullBoxes({ ...view, worldToEye: lately }, doing({ data: box, origin: [0, 0, 0] }, 'origin', grow), integers(66)), 1);
  buffer.begin({ ...view, worldToEye: lately }, doing({ scale: 1 }, 'scale', grow)), buffer.drawMesh(mesh, lately);
  world.addOccluder(doing({ boxes: box }, 'boxes', grow));
  rays.aim({ ...view, worldToEye: lately }, 2, 2);
  assert.ok(grown > 8, `${grown} times`);
  // What lies in the memory that was is refused; what was disposed of meanwhile, too.
  const own = floats(6), other = new Culler();
  own.array.set(box);
  assert.throws(() => world.insert(doing({ data: own.array, stride: 6 }, 'stride', grow)), (error) => error.code === 'detached');
  assert.throws(() => other.cull(world, doing(view, 'width', () => other.dispose())), (error) => error.code === 'disposed');
  assert.throws(() => world.insert(doing({ data: own, origin: [0, 0, 0] }, 'origin', () => own.dispose())), (error) => error.code === 'disposed');
  assert.equal(world.size, 1);
});
