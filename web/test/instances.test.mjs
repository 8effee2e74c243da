// InstancedMeshes under SightlineCuller without a browser: what three would send and draw, frame by frame.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import * as THREE from 'three';
import { ready, SightlineCuller } from 'sightline-culling/three';
import { add, look, matrixOf, places, random } from '../scenes/city.mjs';

const renderer = { isWebGLRenderer: true, sortObjects: true };

// Attributes as WebGLRenderer sends them: the ranges, or all of what is not there yet.
class Gpu {
  #sent = new Map();
  of(attribute) {
    return this.#sent.get(attribute).array;
  }
  send(attribute) {
    const { array, version, updateRanges } = attribute, sent = this.#sent.get(attribute);
    if (sent?.version === version) return;
    if (!sent) this.#sent.set(attribute, { array: array.slice(), version });
    else if (updateRanges.length === 0) sent.array.set(array);
    else for (const { start, count } of updateRanges) sent.array.set(array.subarray(start, start + count), start);
    if (sent) sent.version = version;
    if (sent && updateRanges.length > 0) attribute.clearUpdateRanges();
    attribute.onUploadCallback();
  }
}

async function makeCity(count) {
  await ready;
  const scene = new THREE.Scene(), { all, side } = places(count);
  add(scene, 'instanced', all, new THREE.MeshBasicMaterial());
  const [mesh] = scene.children, camera = new THREE.PerspectiveCamera(60, 1.5, 0.1, 500), gpu = new Gpu();
  const culler = new SightlineCuller(scene, { occlusion: false });
  await new Promise((loaded) => setTimeout(loaded, 10));
  const box = new THREE.Box3(), unit = new THREE.Box3(new THREE.Vector3(-0.5, -0.5, -0.5), new THREE.Vector3(0.5, 0.5, 0.5));
  const frustum = new THREE.Frustum(), matrix = new THREE.Matrix4();
  // Draws a frame; which instances the GPU has, and in view, that were not drawn as they are.
  const draw = () => {
    camera.updateMatrixWorld(), scene.updateMatrixWorld();
    scene.onBeforeRender(renderer, scene, camera, null);
    const { instanceMatrix, count: drawn } = mesh, isListed = scene.children.includes(mesh);
    if (isListed) gpu.send(instanceMatrix);
    scene.onAfterRender(renderer, scene, camera, null);
    const rows = new Set();
    for (let i = 0; isListed && i < drawn; ++i) rows.add(gpu.of(instanceMatrix).subarray(16 * i, 16 * i + 16).join());
    frustum.setFromProjectionMatrix(matrix.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse));
    const own = mesh.instanceMatrix.array, lost = [];
    for (let i = 0; i < mesh.count; ++i) {
      const inView = frustum.intersectsBox(box.copy(unit).applyMatrix4(matrix.fromArray(own, 16 * i)));
      if (inView && !rows.has(own.subarray(16 * i, 16 * i + 16).join())) lost.push(i);
    }
    return { lost, isWhole: isListed && instanceMatrix === mesh.instanceMatrix };
  };
  return { mesh, camera, culler, all, side, draw };
}

test('three is sent all that moved while a shorter copy was drawn, or nobody culled', async () => {
  const { mesh, camera, culler, all, side, draw } = await makeCity(1200), next = random(5), drawn = { whole: 0, some: 0 };
  const turn = (i) => mesh.setMatrixAt(i, matrixOf({ ...all[i], at: [next() * side, 1, next() * side] }));
  for (let frame = 0; frame < 600; ++frame) {
    look(camera, next, side);
    if (next() < 0.3) camera.position.set(side / 2, 300, side / 2), camera.lookAt(side / 2, 0, side / 2 + 1);
    if (next() < 0.1) culler.enabled = !culler.enabled;
    const how = next();
    for (let k = 0; how < 0.8 && k < 5; ++k) {
      const i = Math.floor(next() * all.length);
      turn(i);
      if (how < 0.6) mesh.instanceMatrix.addUpdateRange(16 * i, 16);
      if (how < 0.3) mesh.instanceMatrix.needsUpdate = true; // as often as anything moves
    }
    if (how < 0.8) mesh.instanceMatrix.needsUpdate = true;
    const { lost, isWhole } = draw();
    assert.deepEqual(lost, [], `frame ${frame}`);
    ++drawn[isWhole ? 'whole' : 'some'];
  }
  assert.ok(drawn.whole > 100 && drawn.some > 100, JSON.stringify(drawn));
  const own = mesh.instanceMatrix;
  culler.enabled = true, camera.position.set(12, 2, 45), camera.rotation.set(0, 0, 0);
  turn(0), own.addUpdateRange(0, 16), (own.needsUpdate = true);
  assert.equal(draw().isWhole, false);
  culler.dispose();
  turn(1), own.addUpdateRange(16, 16), (own.needsUpdate = true);
  camera.position.set(side / 2, 300, side / 2), camera.lookAt(side / 2, 0, side / 2 + 1);
  assert.deepEqual(draw().lost, []);
});

test('an InstancedMesh most of which moves in every frame is left to three until it rests', async () => {
  const { mesh, camera, culler, all, side, draw } = await makeCity(3000), next = random(8);
  const set = (place, i) => mesh.setMatrixAt(i, matrixOf({ ...place, at: [next() * side, 1, next() * side] }));
  const frame = (moves) => {
    if (moves === 'all') all.forEach(set);
    if (moves === 'one') set(all[0], 0), mesh.instanceMatrix.addUpdateRange(0, 16);
    if (moves !== 'none') mesh.instanceMatrix.needsUpdate = true;
    look(camera, next, side);
    const { lost, isWhole } = draw();
    assert.deepEqual(lost, []);
    return isWhole;
  };
  const count = (moves, frames) => Array.from({ length: frames }, () => frame(moves)).filter((isWhole) => isWhole).length;
  assert.ok(count('none', 20) < 5);
  for (const calm of ['none', 'one']) {
    assert.ok(count('all', 3) < 3);
    count('all', 2);
    assert.equal(count('all', 20), 20);
    assert.equal(culler.stats.objects, 0);
    count(calm, 18);
    assert.ok(count(calm, 20) < 5, 'it is culled again');
    assert.equal(culler.stats.objects, all.length);
  }
  culler.dispose();
});
