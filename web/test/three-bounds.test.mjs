// Where things are for the culler: as far off as a world goes, and wherever three's own spheres have them.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import * as THREE from 'three';
import { begin, meshAt } from './walked.mjs';

const sphere = (x, y, z, radius) => new THREE.Sphere(new THREE.Vector3(x, y, z), radius);

test('what lies far off is drawn, and what is nowhere or too far off from everywhere', async () => {
  for (const x of [9e9, 1.2e10, 5e10, 9.9e10]) {
    const { scene, camera, culler, frame } = await begin(), near = meshAt(x, 0, -50, [10, 10, 10]), nowhere = meshAt(NaN, 0, 0);
    const beyond = meshAt(2e11, 0, 0);
    camera.position.x = x, scene.add(near, nowhere, beyond);
    assert.deepEqual([near, nowhere, beyond].map((mesh) => frame().includes(mesh)), [true, true, true], `${x}`);
    assert.equal(culler.stats.drawn, 3);
    culler.dispose();
  }
});

test('a sphere of its own has a mesh drawn where three draws it', async () => {
  const { scene, culler, frame } = await begin(), mesh = meshAt(50, 0, -5);
  scene.add(mesh);
  assert.ok(!frame().includes(mesh));
  mesh.boundingSphere = sphere(0, 0, 0, 60);
  assert.ok(frame().includes(mesh));
  mesh.boundingSphere.center.x = 500;
  assert.ok(!frame().includes(mesh));
  culler.dispose();
});

test('a sphere of its own has instances drawn where three draws them, but not the one that three makes of them', async () => {
  const { scene, culler, frame } = await begin({ occlusion: false });
  const mesh = new THREE.InstancedMesh(new THREE.BoxGeometry(), new THREE.MeshBasicMaterial(), 10);
  const place = (side) => {
    for (let i = 0; i < 10; ++i) mesh.setMatrixAt(i, new THREE.Matrix4().makeTranslation(i < 3 ? 0 : 40 + side + i, 0, -9 - 2 * i));
    mesh.instanceMatrix.needsUpdate = true;
  };
  const drawn = () => {
    let count = 0;
    const isListed = frame(() => ({ count } = mesh)).includes(mesh);
    return isListed ? count : 0;
  };
  place(0), scene.add(mesh);
  for (let side = 0; side < 4; ++side) place(side), assert.equal(drawn(), 3);
  scene.add(new THREE.Group()), place(9), assert.equal(drawn(), 3); // all is made anew
  place(20), mesh.computeBoundingSphere(), assert.equal(drawn(), 3);
  place(0), assert.equal(drawn(), 3);
  mesh.boundingSphere = sphere(0, 0, 0, 1000), assert.equal(drawn(), 10);
  mesh.boundingSphere.set(new THREE.Vector3(30, 0, -18), 1), assert.equal(drawn(), 3); // within three's own
  mesh.boundingSphere.radius = 1000, assert.equal(drawn(), 10);
  mesh.boundingSphere = null, assert.equal(drawn(), 3);
  culler.dispose();
});

test('a geometry\'s sphere that is moved, or replaced by one as large, is noticed', async () => {
  const { scene, culler, frame } = await begin(), mesh = meshAt(50, 0, -5);
  mesh.geometry.boundingSphere = sphere(0, 0, 0, 5), scene.add(mesh);
  for (let round = 0; round < 2; ++round) {
    assert.ok(!frame().includes(mesh));
    mesh.geometry.boundingSphere.center.x = -50, assert.ok(frame().includes(mesh));
    mesh.geometry.boundingSphere = sphere(0, 0, 0, 5);
  }
  culler.dispose();
});

test('what three does not draw, by a sphere that is too small or too old, hides nothing', async () => {
  const { scene, culler, frame } = await begin(), hidden = meshAt(0, 0, -30), wall = meshAt(0, 0, -10, [8, 8, 8]);
  scene.add(hidden, wall);
  assert.ok(!frame().includes(hidden));
  wall.geometry.boundingSphere = sphere(300, 0, 0, 0.1);
  assert.ok(frame().includes(hidden));
  scene.remove(wall);
  const instanced = new THREE.InstancedMesh(new THREE.BoxGeometry(8, 8, 1), wall.material, 1);
  instanced.setMatrixAt(0, new THREE.Matrix4().makeTranslation(0, 0, 100));
  instanced.computeBoundingSphere(), instanced.setMatrixAt(0, new THREE.Matrix4().makeTranslation(0, 0, -10));
  scene.add(instanced), assert.ok(frame().includes(hidden));
  instanced.computeBoundingSphere(), assert.ok(!frame().includes(hidden));
  culler.dispose();
});
