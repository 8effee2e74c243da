// The package answers as the library does natively: the same ids and masks in the same order, over 1,000 random worlds that
// live, with layers, contribution and occlusion, drawn by hand and by the library itself; flat culling and rays, too, to the bit. test/native_worlds.cpp says how the
// file is laid out.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import {
  BoxBvh, Culler, cullBoxes, floats, integers, OcclusionBuffer, ready, World } from 'sightline-culling';
import { Reader } from './reader.mjs';

const file = new URL('../../build/web/worlds.bin', import.meta.url);

function expectCull(reader, culled) {
  const count = reader.integer();
  assert.deepEqual(culled.ids, reader.many(Uint32Array, count));
  assert.deepEqual(culled.masks, reader.many(Uint8Array, count));
  return count;
}

function frame(reader, { world, culler, buffer }) {
  const views = Array.from({ length: reader.integer() }, () => {
    const view = reader.view();
    return { ...view, layers: reader.integer(), minArea: reader.many(Float32Array, 1)[0] };
  });
  const walls = reader.many(Float64Array, 6 * reader.integer());
  expectCull(reader, culler.cull(world, views));
  buffer.begin(views[0]);
  buffer.drawBoxes(walls);
  const occluded = culler.cull(world, { ...views[0], occlusion: buffer });
  expectCull(reader, occluded);
  return occluded.culledOcclusion;
}

function change(reader, { world }, handles) {
  const moved = reader.many(Uint32Array, reader.integer());
  const boxes = reader.many(Float64Array, 6 * moved.length);
  world.move(Float64Array.from(moved, (i) => handles[i]), boxes);
  for (const i of reader.many(Uint32Array, reader.integer())) world.remove(handles.splice(i, 1)[0]);
  const more = reader.many(Float64Array, 6 * reader.integer());
  handles.push(...world.insert(more));
}

function flat(reader, { bvh, out }) {
  const count = reader.integer(), view = reader.view(), boxes = reader.many(Float32Array, 6 * count);
  const seen = reader.integer();
  assert.equal(cullBoxes({ ...view, origin: [0, 0, 0] }, boxes, out), seen);
  const expected = reader.many(Uint32Array, seen);
  assert.deepEqual(out.array.slice(0, seen), expected);
  const columns = new Float32Array(6 * count);
  boxes.forEach((x, i) => (columns[(i % 6) * count + Math.floor(i / 6)] = x));
  assert.equal(cullBoxes({ ...view, origin: [0, 0, 0] }, { data: columns, layout: 'columns' }, out), seen);
  assert.deepEqual(out.array.slice(0, seen), expected);

  const rays = reader.many(Float32Array, 7 * 64), objects = integers(64), distances = floats(64);
  bvh.build(boxes);
  bvh.cast(rays, objects, distances);
  assert.deepEqual(objects.array, reader.many(Uint32Array, 64));
  assert.deepEqual(new Uint32Array(distances.array.slice().buffer), reader.many(Uint32Array, 64));
  objects.dispose(), distances.dispose();
}

const cube = {
  positions: Float32Array.from({ length: 24 }, (_, i) => (Math.floor(i / 3) >> i % 3) & 1),
  indices: Uint32Array.of(0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6),
  sides: Uint8Array.of(1), solidTriangles: 12 };

// As write_automatic() there.
function automatic(reader, world) {
  const walls = reader.many(Float64Array, 6 * 9), transforms = reader.many(Float32Array, 16 * 9);
  const origin = reader.many(Float64Array, 3), handles = world.insert(walls), culler = new Culler();
  const cubes = [world.addOccluder({ boxes: Float32Array.of(0, 0, 0, 1, 1, 1) }), world.addOccluder(cube),
    world.addOccluder({ spheres: Float32Array.of(0.5, 0.5, 0.5, 0.5) })];
  world.setOccluders(handles, Uint32Array.from(handles, (_, i) => cubes[i % 3]), transforms, [...origin]);
  const count = reader.integer(), costs = { object: reader.many(Float32Array, 1)[0] };
  let hidden = 0;
  for (let frame = 0; frame < 6; ++frame) {
    const views = Array.from({ length: count }, () => reader.view());
    if (frame === 2) world.setOccluding(handles, Uint8Array.of(0, 1, 0, 1, 0, 1, 0, 1, 0));
    if (frame === 3) world.setTriangles(handles[8], Float32Array.of(-1, 0, 0, 1, 0, 0, 0, 1, 0), views[0].origin);
    const culled = culler.cull(world, views, { occlusion: 'automatic', costs });
    const { culledOcclusion, cost, frustumCost } = culled;
    const drawn = expectCull(reader, culled);
    assert.deepEqual(Float64Array.of(culledOcclusion, cost, frustumCost), reader.many(Float64Array, 3));
    culler.reportFrameTime(1e5 + 3e3 * drawn);
    hidden += culledOcclusion;
  }
  culler.dispose();
  return hidden;
}

test('1,000 random worlds are culled as natively', async () => {
  await ready;
  const reader = new Reader(readFileSync(file));
  const worlds = reader.integer();
  assert.equal(worlds, 1000);
  const shared = { culler: new Culler(), buffer: new OcclusionBuffer(), bvh: new BoxBvh(), out: integers(4096) };
  let occluded = 0, automatically = 0;
  for (let w = 0; w < worlds; ++w) {
    const boxes = reader.many(Float64Array, 6 * reader.integer());
    const world = new World();
    const layers = reader.many(Uint32Array, boxes.length / 6);
    const handles = Array.from(world.insert(boxes, { layers }));
    for (let f = 0; f < 3; ++f) {
      occluded += frame(reader, { world, ...shared });
      change(reader, { world }, handles);
    }
    flat(reader, shared);
    automatically += automatic(reader, world);
    world.dispose();
  }
  assert.equal(reader.left, 0);
  assert.ok(occluded > 1000, `occlusion culled ${occluded}`);
  assert.ok(automatically > 1000, `automatic occlusion culled ${automatically}`);
});
