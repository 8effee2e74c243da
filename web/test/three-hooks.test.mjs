// A scene under SightlineCuller whose owner does things to it, too.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { setFlagsFromString } from 'node:v8';
import { runInNewContext } from 'node:vm';
import * as THREE from 'three';
import { bytes, SightlineError } from 'sightline-culling';
import { ready, SightlineCuller } from 'sightline-culling/three';
import { withPage } from './browser/chromium.mjs';

const page = `${import.meta.dirname}/browser/hooks.mjs`;
const renderer = { isWebGLRenderer: true, sortObjects: true }, camera = new THREE.PerspectiveCamera(60, 1.5, 0.1, 500);
const loaded = () => new Promise((resolve) => setTimeout(resolve, 10));

test('what is done to a scene while and between it is drawn is as without the culler', async () => {
  await withPage(page, async (tab) => {
    await tab.waitForFunction(() => window.play);
    for (const [name, { differs, off, on, culled, shy }] of Object.entries(await tab.evaluate(() => window.play()))) {
      assert.deepEqual(differs.filter((pixels) => pixels > 0), [], `${name}: ${differs}`);
      assert.deepEqual(on, off, name);
      assert.ok(culled > 0, `${name}: nothing was culled`);
      assert.equal(shy, 0, `${name}: too little was hidden`);
    }
  });
});

const hooks = ['onBeforeRender', 'onAfterRender', 'add', 'remove', 'attach', 'clear'];
const ownOf = (scene) => hooks.filter((name) => Object.hasOwn(scene, name));

test('dispose() takes away what the culler has put there, once, and leaves what came after it', async () => {
  await ready;
  const scene = new THREE.Scene(), first = new SightlineCuller(scene), calls = [], { onAfterRender } = scene;
  scene.onBeforeRender = () => calls.push('before');
  scene.onAfterRender = (...all) => (calls.push('after'), onAfterRender(...all));
  first.dispose();
  assert.deepEqual(ownOf(scene), ['onBeforeRender', 'onAfterRender']);
  scene.onBeforeRender(renderer, scene, camera, null), scene.onAfterRender(renderer, scene, camera);
  assert.deepEqual(calls, ['before', 'after']);
  delete scene.onBeforeRender, delete scene.onAfterRender;
  const second = new SightlineCuller(scene);
  first.dispose();
  assert.deepEqual(ownOf(scene), hooks);
  second.dispose();
  assert.deepEqual(ownOf(scene), []);
});

test('the list of children is whole from the next microtask on after a callback has thrown', async () => {
  await ready;
  const scene = new THREE.Scene(), { children } = scene, culler = new SightlineCuller(scene, { occlusion: false });
  const instanced = new THREE.InstancedMesh(new THREE.BoxGeometry(), new THREE.MeshBasicMaterial(), 10), { instanceMatrix } = instanced;
  for (let i = 0; i < 10; ++i) instanced.setMatrixAt(i, new THREE.Matrix4().makeTranslation(0, 0, i < 3 ? -5 : 50));
  scene.add(instanced, new THREE.Mesh(new THREE.BoxGeometry())), (scene.children[1].position.z = 50);
  camera.updateMatrixWorld(), scene.updateMatrixWorld();
  const throws = () => {
    scene.onBeforeRender(renderer, scene, camera, null);
    assert.deepEqual([scene.children.length, instanced.count], [1, 3]);
    throw new Error('of a callback');
  };
  for (let round = 0; round < 3; ++round) {
    assert.throws(throws, /of a callback/);
    await Promise.resolve();
    assert.deepEqual([scene.children === children, scene.children.length, instanced.count], [true, 2, 10]);
    assert.equal(instanced.instanceMatrix, instanceMatrix);
  }
  culler.dispose();
});

test('what is added keeps the matrix that the user has given it, and is culled by that', async () => {
  await ready;
  const scene = new THREE.Scene(), group = new THREE.Group(), culler = new SightlineCuller(scene, { occlusion: false });
  const meshes = [0, 1].map(() => new THREE.Mesh(new THREE.BoxGeometry(), new THREE.MeshBasicMaterial()));
  for (const each of [scene, group, ...meshes]) each.matrixAutoUpdate = false;
  scene.add(group, new THREE.Mesh(new THREE.BoxGeometry()).translateZ(50));
  const draw = () => {
    scene.updateMatrixWorld(), camera.updateMatrixWorld(), scene.onBeforeRender(renderer, scene, camera, null);
    const { children } = scene;
    return scene.onAfterRender(), meshes.map((mesh) => children.includes(mesh));
  };
  draw();
  const places = () => [group, ...meshes].map(({ matrixWorld }) => matrixWorld.elements[14]);
  group.matrixWorld.makeTranslation(0, 0, 7), meshes.forEach(({ matrixWorld }, i) => matrixWorld.makeTranslation(0, 0, [-6, 50][i]));
  group.add(...meshes);
  assert.deepEqual(places(), [7, -6, 50]);
  assert.deepEqual([draw(), places()], [[true, false], [7, -6, 50]]);
  culler.dispose();
});

test('stats are of the frame, not of what was rendered within it', async () => {
  await ready;
  const scene = new THREE.Scene(), culler = new SightlineCuller(scene, { occlusion: false }), away = camera.clone();
  away.rotateY(Math.PI), away.updateMatrixWorld(), camera.updateMatrixWorld();
  scene.add(...[-6, -8, 50].map((z) => new THREE.Mesh(new THREE.BoxGeometry()).translateZ(z))), scene.updateMatrixWorld();
  const within = (eye, then = () => {}) => (scene.onBeforeRender(renderer, scene, eye, null), then(), scene.onAfterRender());
  within(camera, () => within(away, () => assert.equal(culler.stats.drawn, 1)));
  assert.deepEqual(culler.stats, { objects: 3, drawn: 2, hidden: 0, occluders: 0 });
  culler.dispose();
});

test('a scene has one culler', async () => {
  const scene = new THREE.Scene(), culler = new SightlineCuller(scene);
  assert.throws(() => new SightlineCuller(scene), (error) => error instanceof SightlineError && /has one already/.test(error.message));
  culler.dispose();
  new SightlineCuller(scene).dispose();
});

// A box before the eye that is another for every frame; how much the module's memory grows once so many have
// gone by.
async function stream(frames, settled, discard) {
  await ready;
  const scene = new THREE.Scene(), culler = new SightlineCuller(scene), probe = bytes(1);
  let size = 0, occluders = 0;
  scene.add(new THREE.Mesh(new THREE.BoxGeometry(), new THREE.MeshBasicMaterial()));
  scene.children[0].position.z = 50; // behind, lest all be in view and left to three
  await loaded();
  for (let frame = 0; frame < frames; ++frame) {
    const mesh = new THREE.Mesh(new THREE.BoxGeometry(2, 2, 2), new THREE.MeshBasicMaterial());
    mesh.position.z = -10, scene.add(mesh), camera.updateMatrixWorld(), scene.updateMatrixWorld();
    scene.onBeforeRender(renderer, scene, camera, null), scene.onAfterRender(renderer, scene, camera);
    occluders += culler.stats.occluders;
    scene.remove(mesh), await discard(mesh, frame);
    if (frame === settled) size = probe.array.buffer.byteLength;
  }
  assert.equal(occluders, frames);
  const grown = probe.array.buffer.byteLength - size;
  return culler.dispose(), probe.dispose(), grown;
}

test('occluders go with their geometries', async () => {
  setFlagsFromString('--expose-gc');
  const collect = runInNewContext('gc');
  assert.equal(await stream(2000, 400, ({ geometry }) => geometry.dispose()), 0);
  // Dropped without a word. What is collected is told of in a turn of its own, not always the next.
  const drop = async (_, frame) => {
    for (let turn = 0; frame % 100 === 0 && turn < 4; ++turn) collect(), await loaded();
  };
  // How many lie about at most until the collector runs shows later than what one frame takes.
  assert.equal(await stream(2000, 1000, drop), 0);
});

test('instances that come and go in ever other numbers take no more memory', async () => {
  await ready;
  const scene = new THREE.Scene(), culler = new SightlineCuller(scene), camera = new THREE.PerspectiveCamera(), probe = bytes(1);
  const geometry = new THREE.BoxGeometry(), material = new THREE.MeshBasicMaterial();
  camera.updateMatrixWorld(), await loaded();
  let size = 0;
  for (let i = 0; i < 300; ++i) {
    const mesh = new THREE.InstancedMesh(geometry, material, 2000 + i);
    scene.add(mesh);
    scene.onBeforeRender({ isWebGLRenderer: true, sortObjects: true }, scene, camera, null), scene.onAfterRender();
    assert.equal(culler.stats.objects, mesh.count);
    scene.remove(mesh), mesh.dispose();
    if (i === 20) size = probe.array.buffer.byteLength;
  }
  const grown = probe.array.buffer.byteLength - size;
  culler.dispose(), probe.dispose();
  assert.ok(grown < 2 ** 20, `${grown} bytes`);
});

test('occluders go with the culler', async () => {
  await ready;
  const probe = bytes(1), geometries = Array.from({ length: 100 }, () => new THREE.BoxGeometry(2, 2, 2));
  let size = 0;
  for (let round = 0; round < 30; ++round) {
    const scene = new THREE.Scene(), culler = new SightlineCuller(scene);
    await loaded();
    const meshes = geometries.map((geometry) => new THREE.Mesh(geometry.clone(), new THREE.MeshBasicMaterial()));
    meshes.forEach((mesh, i) => mesh.position.set((i % 10) - 5, Math.floor(i / 10) - 5, -15)), scene.add(...meshes);
    geometries.splice(0, Infinity, ...meshes.map(({ geometry }) => geometry)); // kept
    camera.updateMatrixWorld(), scene.updateMatrixWorld();
    scene.onBeforeRender(renderer, scene, camera, null), scene.onAfterRender(renderer, scene, camera);
    assert.ok(culler.stats.occluders > 50);
    culler.dispose();
    if (round === 3) size = probe.array.buffer.byteLength;
  }
  assert.equal(probe.array.buffer.byteLength, size);
});
