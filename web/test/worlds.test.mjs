// The package answers as the library does natively: the same ids and masks in the same order, over 1,000 random worlds that
// live, with layers, contribution and occlusion; flat culling and rays, too, to the bit. test/native_worlds.cpp says how the
// file is laid out.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import {
  BoxBvh, Culler, cullBoxes, floats, integers, OcclusionBuffer, ready, World } from 'sightline-culling';

const file = new URL('../../build/web/worlds.bin', import.meta.url);

class Reader {
  #data; #at = 0;
  constructor(buffer) { this.#data = buffer; }
  many(kind, count) {
    const bytes = count * kind.BYTES_PER_ELEMENT;
    const copy = this.#data.buffer.slice(this.#data.byteOffset + this.#at, this.#data.byteOffset + this.#at + bytes);
    this.#at += bytes;
    return new kind(copy);
  }
  integer() { return this.many(Uint32Array, 1)[0]; }
  view() {
    const [worldToEye, eyeToClip] = [this.many(Float32Array, 16), this.many(Float32Array, 16)];
    return { worldToEye, eyeToClip, width: this.integer(), height: this.integer(), origin: this.many(Float64Array, 3) };
  }
  get left() { return this.#data.length - this.#at; }
}

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

test('1,000 random worlds are culled as natively', async () => {
  await ready;
  const reader = new Reader(readFileSync(file));
  const worlds = reader.integer();
  assert.equal(worlds, 1000);
  const shared = { culler: new Culler(), buffer: new OcclusionBuffer(), bvh: new BoxBvh(), out: integers(4096) };
  let occluded = 0;
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
    world.dispose();
  }
  assert.equal(reader.left, 0);
  assert.ok(occluded > 1000, `occlusion culled ${occluded}`);
});
