// What shows elsewhere than its points say, or through others, must show under SightlineCuller.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import * as THREE from 'three';
import { ClippingGroup } from 'three/webgpu';
import { ready, SightlineCuller } from 'sightline-culling/three';
import { withPage } from './browser/chromium.mjs';

async function isAsWithout(cases) {
  await withPage(`${import.meta.dirname}/browser/${cases}.mjs`, async (tab) => {
    await tab.waitForFunction(() => window.play);
    for (const [name, { differs, off, on, culled, shy }] of Object.entries(await tab.evaluate(() => window.play()))) {
      assert.deepEqual(differs.filter((pixels) => pixels > 0), [], `${name}: ${differs}`);
      assert.deepEqual(on, off, name);
      assert.ok(culled > 0, `${name}: nothing was culled`);
      assert.equal(shy, 0, `${name}: too little was hidden`);
    }
  });
}

test('what is displaced, marked, mirrored, overridden or drawn over all is as without the culler', () => isAsWithout('shown'));
test('what changes later, or is done by shaders and mirrors, is as without the culler', () => isAsWithout('changed'));

test('a group that clips its children is handed to three with them', async () => {
  await ready;
  const scene = new THREE.Scene(), group = new ClippingGroup(), mesh = new THREE.Mesh(new THREE.BoxGeometry());
  const camera = new THREE.PerspectiveCamera(60, 1.5, 0.1, 500), behind = new THREE.Mesh(mesh.geometry);
  mesh.position.z = -9, (behind.position.z = 9), scene.add(group.add(mesh), behind), scene.updateMatrixWorld(), camera.updateMatrixWorld();
  const culler = new SightlineCuller(scene);
  await new Promise((loaded) => setTimeout(loaded, 10));
  scene.onBeforeRender({ isWebGLRenderer: true, sortObjects: true }, scene, camera, null);
  const { children } = scene;
  scene.onAfterRender();
  culler.dispose();
  assert.ok(children.includes(group) && !children.includes(mesh) && !children.includes(behind));
});
