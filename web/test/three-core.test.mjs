// The culler in a program that has loaded the smaller module, which lacks what it needs.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import * as THREE from 'three';
import { bytes, ready } from 'sightline-culling/core';

test('where the module lacks occlusion the scene is drawn whole, which is said once and takes no memory', async (t) => {
  await ready;
  const { SightlineCuller } = await import('sightline-culling/three'), { mock } = t.mock.method(console, 'warn', () => {});
  const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(), culler = new SightlineCuller(scene), probe = bytes(1);
  scene.add(new THREE.Mesh(new THREE.BoxGeometry()));
  let size = 0;
  for (let frame = 0; frame < 2000; ++frame) {
    scene.onBeforeRender({ isWebGLRenderer: true, sortObjects: true }, scene, camera, null);
    assert.equal(scene.children.length, 1);
    scene.onAfterRender();
    if (frame === 200) size = probe.array.buffer.byteLength;
  }
  assert.equal(probe.array.buffer.byteLength, size);
  assert.deepEqual(mock.calls.map(({ arguments: [said] }) => /`core` has no occlusion_create/.test(said)), [true]);
  culler.dispose();
});
