// No object that shows is lost to the package's occlusion: generated worlds, random views of them, and who is visible in
// truth, as scenes/native_scenes.cpp wrote them.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { Culler, ready, World } from 'sightline-culling';
import { Reader } from './reader.mjs';

const file = new URL('../../build/web/scenes.bin', import.meta.url);

function readOccluder(reader) {
  const counted = (kind, numbers) => reader.many(kind, numbers * reader.integer());
  const positions = counted(Float32Array, 3), indices = counted(Uint32Array, 1), sides = counted(Uint8Array, 1);
  const solidTriangles = reader.integer(), boxes = counted(Float32Array, 6), spheres = counted(Float32Array, 4);
  return { positions, indices, sides, solidTriangles, boxes, spheres }; // one sphere at most: its columns are its numbers
}

function readWorld(reader) {
  const world = new World(), handles = world.insert(reader.many(Float32Array, 6 * reader.integer()));
  const occluders = Array.from({ length: reader.integer() }, () => world.addOccluder(readOccluder(reader)));
  const carriers = reader.many(Uint32Array, reader.integer());
  const carried = reader.many(Uint32Array, carriers.length).map((i) => occluders[i]);
  world.setOccluders(Float64Array.from(carriers, (o) => handles[o]), carried, reader.many(Float32Array, 16 * carriers.length));
  return world;
}

test('nothing that shows is lost in generated worlds', async () => {
  await ready;
  const reader = new Reader(readFileSync(file)), culler = new Culler(), options = { occlusion: 'automatic', costs: { object: 1e4 } };
  const worlds = reader.integer(), hidden = [];
  for (let w = 0; w < worlds; ++w) {
    const world = readWorld(reader), views = reader.integer();
    let dropped = 0, lost = 0, seen = 0;
    for (let v = 0; v < views; ++v) {
      const view = reader.view(), visible = reader.many(Uint32Array, reader.integer());
      for (let frame = 0; frame < 5; ++frame) { // what was seen before is what hides
        const { ids, culledOcclusion } = culler.cull(world, view, options), kept = new Set(ids);
        lost += visible.reduce((count, o) => count + (kept.has(o) ? 0 : 1), 0);
        dropped += culledOcclusion, (seen += visible.length);
      }
    }
    assert.equal(lost, 0, `world ${w}: ${lost} of ${seen} visible objects are lost`);
    assert.ok(seen > views, `world ${w}: only ${seen} objects show`);
    hidden.push(dropped);
    world.dispose();
  }
  assert.equal(reader.left, 0);
  assert.ok(hidden.filter((count) => count > 1000).length >= 3, `hidden: ${hidden}`); // of the forest's thin trees next to nothing
});
