// A scene whose culler's module has ended, as it does out of memory.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import * as THREE from 'three';
import { floats, World } from 'sightline-culling';
import { ready, SightlineCuller } from 'sightline-culling/three';

test('after the module has ended a scene changes and is drawn as without the culler, which is said once', async (t) => {
  await ready;
  const { mock } = t.mock.method(console, 'warn', () => {});
  const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(), culler = new SightlineCuller(scene);
  const meshes = Array.from({ length: 4 }, () => new THREE.Mesh(new THREE.BoxGeometry(), new THREE.MeshBasicMaterial()));
  const [near, behind, later, last] = meshes, batch = new THREE.BatchedMesh(2, 30, 40);
  const instanced = new THREE.InstancedMesh(near.geometry, near.material, 3);
  near.position.z = -5, (behind.position.z = 50), scene.add(near, behind, batch, instanced);
  const frame = () => {
    scene.updateMatrixWorld(), scene.onBeforeRender({ isWebGLRenderer: true, sortObjects: true }, scene, camera, null);
    const { children } = scene;
    return scene.onAfterRender(), children;
  };
  assert.ok(!frame().includes(behind) && culler.stats.occluders > 0);
  const world = new World();
  new Uint8Array(floats(6).array.buffer).fill(255); // nothing in the module is what it was
  assert.throws(() => world.insert(new Float32Array(6)), /the module has ended/);
  scene.add(later, last), scene.remove(near, later);
  assert.deepEqual(scene.children, [behind, batch, instanced, last]);
  for (let round = 0; round < 3; ++round) assert.equal(frame(), scene.children);
  near.geometry.dispose(), culler.dispose();
  assert.equal(frame(), scene.children);
  assert.ok(!Object.hasOwn(batch, 'setMatrixAt') && !Object.hasOwn(scene, 'add'));
  assert.deepEqual(mock.calls.map(({ arguments: [said] }) => /draws without culling: .* has ended/.test(said)), [true]);
});
