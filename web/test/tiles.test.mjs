// `sightline-culling/three-tiles` with 3DTilesRendererJS: the same picture of fewer tiles.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import * as THREE from 'three';
import { ready, SightlineTilesPlugin } from 'sightline-culling/three-tiles';
import { withPage } from './browser/chromium.mjs';

test('tiles behind a wall are neither refined nor loaded, and the picture is the same', async () => {
  await withPage(`${import.meta.dirname}/browser/tiles.mjs`, async (tab) => {
    await tab.waitForFunction(() => window.compare);
    const views = await tab.evaluate(() => window.compare());
    if (process.env.VERBOSE) console.log(views);
    const [street, siblings, close, above] = views;
    for (const view of [street, siblings, close, above]) {
      assert.equal(view.differing, 0, JSON.stringify(view));
      assert.ok(view.colours > (view === close ? 0 : 2) && view.occluders > 0, JSON.stringify(view)); // close up, the wall is all there is
    }
    assert.ok(street.asked[1] < 0.7 * street.asked[0] && street.shown[1] < 0.7 * street.shown[0], JSON.stringify(street));
    assert.ok(siblings.asked[1] < 0.9 * siblings.asked[0], JSON.stringify(siblings));
    // What is asked for before the wall is there cannot be known to be hidden.
    assert.ok(close.asked[1] < 0.6 * close.asked[0] && close.shown[1] === 1, JSON.stringify(close));
    assert.ok(above.asked[1] > 0.5 * above.asked[0], JSON.stringify(above));
  });
});

// What of three-tiles' interface the plug-in asks: a camera at 0 that looks down -z, and one tile that is drawn.
function masks(change, again = () => {}) {
  const mesh = new THREE.Mesh(new THREE.BoxGeometry(20, 20, 1), new THREE.MeshBasicMaterial()), scene = new THREE.Group();
  const world = new THREE.Scene(), group = new THREE.Group();
  mesh.position.set(0, 0, -10.5);
  const changed = change(mesh), drawn = changed?.isObject3D ? changed : mesh, camera = new THREE.PerspectiveCamera(60, 2, 0.1, 1000);
  world.add(group.add(scene.add(drawn))), camera.updateMatrixWorld(), world.updateMatrixWorld(), (group.matrixWorldInverse = new THREE.Matrix4());
  const volume = (min, max) => ({ getAABB: (box) => box.set(min, max), distanceToPoint: () => 10 });
  const front = { engineData: { scene, boundingVolume: volume(new THREE.Vector3(-30, -30, -11), new THREE.Vector3(30, 30, -10)) } };
  const back = { engineData: { scene: null, boundingVolume: volume(new THREE.Vector3(-5, -5, -40), new THREE.Vector3(5, 5, -30)) } };
  const plugin = new SightlineTilesPlugin(), tiles = new THREE.EventDispatcher();
  plugin.init(Object.assign(tiles, { group, cameras: [camera], cameraMap: new Map([[camera, { width: 320, height: 160 }]]), visibleTiles: new Set([front]) }));
  const isMasked = () => (tiles.dispatchEvent({ type: 'update-before' }), plugin.calculateTileViewError(back, {}));
  const first = isMasked();
  again(drawn, { world, group, camera, back }), world.updateMatrixWorld();
  const then = isMasked();
  plugin.dispose();
  return [first, then];
}

test('a tile is masked by what is drawn as its geometry stands, and by nothing else', async (given) => {
  await ready;
  const { warn } = console, words = [];
  console.warn = (...all) => words.push(all.join(' '));
  given.after(() => { console.warn = warn; });
  const instanced = (mesh) => {
    const many = new THREE.InstancedMesh(mesh.geometry, mesh.material, 1);
    many.setMatrixAt(0, new THREE.Matrix4().makeTranslation(60, 0, 0)), many.position.copy(mesh.position);
    return many;
  };
  const batched = (mesh) => {
    const batch = new THREE.BatchedMesh(1, 100, 100, mesh.material);
    batch.setMatrixAt(batch.addInstance(batch.addGeometry(mesh.geometry)), new THREE.Matrix4().makeTranslation(60, 0, 0));
    batch.position.copy(mesh.position);
    return batch;
  };
  const skinned = (mesh) => {
    const { count } = mesh.geometry.attributes.position, bone = new THREE.Bone();
    mesh.geometry.setAttribute('skinIndex', new THREE.Uint16BufferAttribute(new Uint16Array(4 * count), 4));
    mesh.geometry.setAttribute('skinWeight', new THREE.Float32BufferAttribute(Array.from({ length: 4 * count }, (_, i) => (i % 4 ? 0 : 1)), 4));
    const bent = new THREE.SkinnedMesh(mesh.geometry, mesh.material);
    bent.position.copy(mesh.position), bent.add(bone), bent.bind(new THREE.Skeleton([bone])), bone.position.set(60, 0, 0);
    return bent;
  };
  const geometryOf = (mesh, made) => { mesh.geometry = Object.assign(made, { index: mesh.geometry.index, attributes: mesh.geometry.attributes }); };
  for (const [name, change] of Object.entries({
    instanced, batched, skinned, layers: (mesh) => mesh.layers.set(4), callback: (mesh) => { mesh.onBeforeRender = (renderer) => renderer.clearDepth(); },
    morphs: (mesh) => { mesh.morphTargetInfluences = [1]; }, 'instances of the geometry': (mesh) => geometryOf(mesh, new THREE.InstancedBufferGeometry()),
    'a sphere elsewhere': (mesh) => { mesh.geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(0, 0, 500), 1); },
    'forbidden by its mark': (mesh) => { mesh.userData.occluder = false; },
    'marked by a small geometry': (mesh) => { mesh.userData.occluder = new THREE.BoxGeometry(1, 1, 1); },
    'several materials': (mesh) => { mesh.material = [mesh.material]; }, displaced: (mesh) => { mesh.material.displacementMap = new THREE.Texture(); },
    'turned over': (mesh) => { mesh.scale.x = -1; }, 'on the GPU alone': (mesh) => {
      mesh.frustumCulled = false, mesh.geometry.setAttribute('position', new THREE.GLBufferAttribute(null, 5126, 3, 4, 24)); },
  })) assert.deepEqual(masks(change), [false, false], name);
  for (const [name, change] of Object.entries({
    plain: () => {}, moved: (mesh) => mesh.position.set(1, 1, -11), 'seen from both sides': (mesh) => { mesh.material.side = THREE.DoubleSide; },
    'not culled by three': (mesh) => { mesh.frustumCulled = false, (mesh.geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(0, 0, 500), 1)); },
    'marked by a geometry within': (mesh) => { mesh.material.displacementMap = null, (mesh.userData.occluder = new THREE.BoxGeometry(19, 19, 1)); },
    'of several materials, all of which it vouches for': (mesh) => { mesh.material = Array(6).fill(mesh.material), (mesh.userData.occluder = true); },
  })) assert.deepEqual(masks(change), [true, true], name);
  const drawnThrough = (geometry, depthWrite = false) => new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ depthTest: false, depthWrite }));
  const late = (geometry, back) => {
    back.engineData.scene = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ transparent: true, depthWrite: false }));
  };
  // What has changed since the last update.
  const inside = (mesh) => mesh.geometry.translate(0, 0, 10.5); // about the eye, which sees the backs of its faces
  for (const [name, change, again] of [
    ['its points', () => {}, (mesh) => mesh.geometry.translate(60, 0, 0)], ['its index', () => {}, (mesh) => mesh.geometry.setIndex([0, 0, 0])],
    ['its range', () => {}, (mesh) => mesh.geometry.setDrawRange(0, 3)],
    ['its side', (mesh) => { inside(mesh), mesh.material.side = THREE.DoubleSide; }, (mesh) => { mesh.material.side = THREE.FrontSide; }],
    ['the camera', () => {}, (_, { camera }) => camera.layers.set(3)],
    // A mirror's, in front of which nothing is drawn.
    ['the near plane', () => {}, (_, { camera }) => { camera.projectionMatrix.elements[6] += 0.1; }],
    ['what clips', () => {}, (_, { world, group }) => world.add(Object.assign(new THREE.Group(), { isClippingGroup: true }).add(group))],
    ['the order', () => {}, (_, { group }) => { group.renderOrder = 1; }],
    ['what the scene overrides', () => {}, (_, { world }) => { world.overrideMaterial = new THREE.MeshBasicMaterial({ transparent: true }); }],
    ['the side that the scene overrides', (mesh) => { inside(mesh), mesh.material.side = THREE.DoubleSide; }, (_, { world }) => {
      world.overrideMaterial = new THREE.MeshBasicMaterial(); }],
    ['what writes depth over others', () => {}, ({ geometry }, { world }) => world.add(drawnThrough(geometry, true))],
    ['what the tiles draw through others', () => {}, (mesh) => mesh.parent.add(drawnThrough(mesh.geometry))],
    ['what the tile draws through others', () => {}, ({ geometry }, { back }) => { back.engineData.scene = drawnThrough(geometry); }],
    ['what the tile draws late, where somebody may have emptied the depth buffer', () => {}, ({ geometry }, { world, back }) => {
      world.add(Object.assign(new THREE.Object3D(), { onBeforeRender: (renderer) => renderer.clearDepth() }));
      late(geometry, back);
    }],
  ]) assert.deepEqual(masks(change, again), [true, false], name);
  assert.deepEqual(masks(() => {}, ({ geometry }, { back }) => late(geometry, back)), [true, true]);
  assert.deepEqual(words, []);
});
