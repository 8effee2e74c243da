// Shadows under SightlineCuller, asked for as each version of three.js asks for them; as the installed one does, in a browser.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import * as THREE from 'three';
import { ready, SightlineCuller } from 'sightline-culling/three';

const renderer = { isWebGLRenderer: true, sortObjects: true, shadowMap: { enabled: true, autoUpdate: true } };
const { updateMatrices } = Object.getPrototypeOf(new THREE.DirectionalLight().shadow);

// Lights' shadows of since 0.182, by a number or not; those of cascades follow the camera.
const spot = () => Object.assign(new THREE.SpotLight(0xffffff, 1, 40, 0.4), { castShadow: true });
function point() {
  const light = new THREE.PointLight(0xffffff, 1, 40);
  light.castShadow = true, Object.assign(light.shadow, { updateMatrices, getViewportCount: () => 1 });
  return light;
}
function sun() {
  const light = new THREE.DirectionalLight(), { shadow } = light;
  const cascades = [0, 1].map((i) => new THREE.OrthographicCamera(-3, 3, 3, -3, 0.1, 10 + i));
  light.castShadow = true;
  return Object.assign(light, { shadow: Object.assign(shadow, {
    getViewportCount: () => 2, getCamera: (i) => cascades[i],
    updateMatrices(_, camera) {
      cascades.forEach((each, i) => (each.position.copy(camera.position), (each.position.x += 15 * i), each.updateMatrixWorld()));
    } }) });
}
const since186 = (light) => (light.shadow.getCamera ??= () => light.shadow.camera, light);

// three's calls for a light, and the camera of each of its views just before it walks the scene for that.
const ups = [[0, -1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1], [0, -1, 0], [0, -1, 0]];
const towards = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
function* walks(light, camera) {
  const { shadow, isPointLight } = light, { getCamera } = shadow, count = isPointLight ? 6 : shadow.getViewportCount();
  if (getCamera && !isPointLight) shadow.updateMatrices(light, camera);
  for (let face = 0; face < count; ++face) {
    if (isPointLight) {
      const { camera: own } = shadow, far = light.distance || own.far;
      if (far !== own.far) (own.far = far), own.updateProjectionMatrix();
      own.position.setFromMatrixPosition(light.matrixWorld), own.up.set(...ups[face]);
      own.lookAt(own.position.clone().add(new THREE.Vector3(...towards[face]))), own.updateMatrixWorld();
    } else if (!getCamera) shadow.updateMatrices(light);
    getCamera ? shadow.getFrustum(face) : shadow.getFrustum();
    yield getCamera ? shadow.getCamera(face) : shadow.camera;
  }
}

async function draw(light, { camera = new THREE.PerspectiveCamera(60, 1.5, 0.1, 500), setCamera, between = () => {} } = {}) {
  await ready;
  const scene = new THREE.Scene(), culler = new SightlineCuller(scene, { occlusion: false }), toClip = new THREE.Matrix4();
  const batch = new THREE.BatchedMesh(1000, 100, 200, new THREE.MeshBasicMaterial()), shape = batch.addGeometry(new THREE.BoxGeometry());
  scene.add(light), light.position.set(1, 2, 3);
  const meshes = Array.from({ length: 1000 }, (_, i) => new THREE.Mesh(new THREE.BoxGeometry(), new THREE.MeshBasicMaterial()));
  meshes.forEach((mesh, i) => mesh.position.set((i % 10) * 4 - 20, (Math.floor(i / 10) % 10) * 4 - 20, Math.floor(i / 100) * 4 - 20));
  meshes.forEach(({ position: { x, y, z } }) => batch.setMatrixAt(batch.addInstance(shape), toClip.clone().makeTranslation(x, y, z)));
  scene.add(...meshes, batch), scene.updateMatrixWorld(), camera.updateMatrixWorld(), (culler.camera = setCamera);
  await new Promise((loaded) => setTimeout(loaded, 10));
  let views = 0, whole = 0;
  for (let frame = 0; frame < 3; ++frame) {
    scene.onBeforeRender(renderer, scene, camera, null), between(light);
    for (const { projectionMatrix, matrixWorldInverse } of walks(light, camera)) {
      const frustum = new THREE.Frustum().setFromProjectionMatrix(toClip.multiplyMatrices(projectionMatrix, matrixWorldInverse));
      const shown = new Set(scene.children);
      batch.onBeforeRender(renderer, null, light.shadow.camera, batch.geometry, batch.material);
      const listed = new Set(batch._indirectTexture.image.data.subarray(0, batch._multiDrawCount));
      const casters = meshes.flatMap((mesh, i) => (frustum.containsPoint(mesh.position) ? [i] : []));
      assert.ok(casters.every((i) => shown.has(meshes[i])), 'casters are lost');
      assert.ok(casters.every((i) => listed.has(i)), 'instances of a batch are lost');
      ++views, (whole += shown.size > 900);
    }
    scene.onAfterRender(renderer, scene, camera, null);
  }
  assert.ok(!Object.hasOwn(light.shadow, 'getFrustum'));
  culler.dispose();
  return { views, whole };
}

test('a light is asked for its views as each three.js does, and what they see is drawn alone', async (t) => {
  const { mock } = t.mock.method(console, 'warn', () => {});
  assert.deepEqual(await draw(spot()), { views: 3, whole: 0 });
  assert.deepEqual(await draw(since186(spot())), { views: 3, whole: 0 });
  assert.deepEqual(await draw(point()), { views: 18, whole: 0 });
  assert.deepEqual(await draw(since186(point())), { views: 18, whole: 0 });
  assert.deepEqual(await draw(sun()), { views: 6, whole: 0 });
  // Of the camera that draws, whichever is culled for.
  const setCamera = new THREE.PerspectiveCamera();
  setCamera.position.x = 100, setCamera.updateMatrixWorld();
  assert.deepEqual(await draw(sun(), { setCamera }), { views: 6, whole: 0 });
  assert.deepEqual(mock.calls, []);
});

test('a light that moves while the scene is drawn finds all of it', async () => {
  const moves = (light) => (light.position.x += 1, light.updateMatrixWorld());
  assert.deepEqual(await draw(spot(), { between: moves }), { views: 3, whole: 3 });
});
