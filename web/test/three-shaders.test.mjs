// What materials, cameras, room to spare and groups that come and go change: where things are, what hides them, and how many.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import * as THREE from 'three';
import { basic, begin, meshAt } from './walked.mjs';

const at = (x, y, z) => new THREE.Matrix4().makeTranslation(x, y, z);

test('what the near plane cuts hides nothing, whatever a camera says of itself', async () => {
  const flat = (near) => new THREE.OrthographicCamera(-10, 10, 10, -10, near, 1000);
  const deep = (near, far, isReversed = false) => {
    const camera = new THREE.PerspectiveCamera(60, 1, 0.1, 1000), { projectionMatrix: p } = camera, top = near * Math.tan(Math.PI / 6);
    p.makePerspective(-top, top, top, -top, near, far === Infinity ? 1e4 : far, camera.coordinateSystem);
    if (far === Infinity) (p.elements[10] = -1), (p.elements[14] = -2 * near);
    // To depths from 1 down to 0, as three has them with reversedDepthBuffer.
    if (isReversed) p.premultiply(new THREE.Matrix4().set(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -0.5, 0.5, 0, 0, 0, 1));
    if (isReversed) Object.defineProperty(camera, 'reversedDepth', { value: true });
    return camera;
  };
  const bare = Object.assign(new THREE.Camera(), { projectionMatrix: deep(5, 1000).projectionMatrix });
  for (const [name, camera, near] of [['orthographic', flat(-10), -10], ['at the eye', flat(0), 0], ['set by hand', deep(5, 1000), 5],
    ['without an end', deep(5, Infinity), 5], ['reversed', deep(5, 1000, true), 5], ['a bare Camera', bare, 5]]) {
    const { scene, culler, frame } = await begin({}, camera), wall = meshAt(0, 0, 0, [100, 100, 1]), behind = meshAt(0, 0, -near - 9);
    scene.add(wall, behind);
    wall.position.z = -near - 0.495; // its front 5 mm before the plane
    assert.ok(frame().includes(behind), `${name}: lost behind a wall that is open`);
    wall.position.z = -near - 0.6;
    assert.ok(!frame().includes(behind), `${name}: nothing is hidden`);
    culler.dispose();
  }
});

test('what a shader of its own may turn is drawn wherever the sphere around it reaches', async () => {
  const { scene, culler, frame } = await begin(), plane = new THREE.PlaneGeometry(10, 10);
  const own = () => new THREE.ShaderMaterial({ vertexShader: 'void main() { gl_Position = vec4(0.); }' });
  const patched = Object.assign(basic(), { onBeforeCompile() {} });
  const standing = at(17, 0, -20).multiply(new THREE.Matrix4().makeRotationY(Math.PI / 2)); // edge on, beside the view
  const mesh = new THREE.Mesh(plane, basic()), instanced = new THREE.InstancedMesh(plane, basic(), 2);
  const batch = new THREE.BatchedMesh(2, 4, 6, basic());
  batch.setMatrixAt(batch.addInstance(batch.addGeometry(plane)), standing);
  for (let i = 0; i < 2; ++i) instanced.setMatrixAt(i, standing);
  standing.decompose(mesh.position, mesh.quaternion, mesh.scale);
  for (const [name, object] of Object.entries({ mesh, instanced, batch })) {
    scene.add(object);
    const isDrawn = (material, marks = {}) => (Object.assign(object, { material, userData: marks }), frame(), culler.stats.drawn > 0);
    assert.ok(!isDrawn(basic()), name);
    for (const material of object === instanced ? [own()] : [own(), patched, [basic(), own()]]) {
      assert.ok(isDrawn(material), name);
      assert.ok(!isDrawn(material, { sightline: true }), `${name}: vouched for`);
      assert.ok(!isDrawn(basic()), name);
    }
    const later = basic();
    assert.ok(!isDrawn(later), name);
    if (object !== instanced) (later.onBeforeCompile = () => {}), (later.needsUpdate = true), assert.ok(isDrawn(later), `${name}: patched later`);
    scene.remove(object);
  }
  culler.dispose();
});

test('instances that a shader counts are all drawn, by an override and by what is included, too', async () => {
  const { scene, culler, frame } = await begin();
  const counting = (lines) => new THREE.ShaderMaterial({ vertexShader: `${lines}\nvoid main() { gl_Position = vec4(id()); }` });
  const id = 'float id() { return float(gl_InstanceID); }';
  Object.assign(THREE.ShaderChunk, { sightline_id: id, sightline_outer: '#include <sightline_id>' });
  const mesh = new THREE.InstancedMesh(new THREE.BoxGeometry(), basic(), 10), seen = () => {
    let count = 0;
    return frame(() => ({ count } = mesh)).includes(mesh) ? count : 0;
  };
  for (let i = 0; i < 10; ++i) mesh.setMatrixAt(i, at(0, 0, i < 3 ? -5 : 50));
  scene.add(mesh);
  assert.equal(seen(), 3);
  for (const override of [counting(id), Object.assign(basic(), { onBeforeCompile() {} })])
    (scene.overrideMaterial = override), assert.equal(seen(), 10);
  scene.overrideMaterial = basic(), assert.equal(seen(), 3);
  scene.overrideMaterial = null;
  for (const lines of ['#include <sightline_id>', '  #include <sightline_outer>']) (mesh.material = counting(lines)), assert.equal(seen(), 10);
  mesh.material = counting('#include <common>\n#include <morphinstance_vertex>\nfloat id() { return 0.; }'), assert.equal(seen(), 3);
  delete THREE.ShaderChunk.sightline_id, delete THREE.ShaderChunk.sightline_outer;
  culler.dispose();
});

test('room for more counts nowhere', async () => {
  const { scene, culler, frame } = await begin({ occlusion: false }), box = new THREE.BoxGeometry(), many = 1000;
  const batch = new THREE.BatchedMesh(many, 24, 36, basic()), instanced = new THREE.InstancedMesh(box, basic(), many);
  const shape = batch.addGeometry(box), stats = () => (frame(), [culler.stats.objects, culler.stats.drawn]);
  const add = (z) => {
    const instance = batch.addInstance(shape);
    return batch.setMatrixAt(instance, at(0, 0, z)), instance;
  };
  const first = add(-5);
  add(-7), add(50);
  scene.add(batch);
  assert.deepEqual(stats(), [4, 2]);
  batch.deleteInstance(first);
  assert.deepEqual(stats(), [3, 1]);
  add(-9), assert.deepEqual(stats(), [4, 2]);
  scene.remove(batch), assert.deepEqual(stats(), [1, 0]);

  for (let i = 0; i < many; ++i) instanced.setMatrixAt(i, at(0, 0, i % 2 ? 50 : -5 - i / 2));
  instanced.count = 3, scene.add(instanced);
  for (const count of [3, 0, 10, 7, many, 1, 0]) {
    instanced.count = count;
    assert.deepEqual(stats(), [1 + count, Math.ceil(count / 2)], `${count}`);
  }
  // What is set of those that are not drawn shows once they are.
  instanced.setMatrixAt(1, at(0, 0, -3)), (instanced.instanceMatrix.needsUpdate = true), assert.deepEqual(stats(), [1, 0]);
  instanced.count = 2, assert.deepEqual(stats(), [3, 2]);
  scene.remove(instanced), assert.deepEqual(stats(), [1, 0]);
  culler.dispose();
});

test('a geometry that changes in every frame is no occluder until it rests', async () => {
  const { scene, culler, frame } = await begin(), wall = meshAt(0, 0, -5, [10, 10, 1]), { position } = wall.geometry.attributes;
  scene.add(wall);
  const occluders = () => (frame(), culler.stats.occluders);
  assert.equal(occluders(), 1);
  for (let i = 0; i < 6; ++i) (position.needsUpdate = true), assert.equal(occluders(), 0);
  let frames = 1;
  for (; occluders() === 0; ++frames) assert.ok(frames < 400);
  assert.ok(frames > 100, `${frames} frames`);
  position.needsUpdate = true, assert.equal(occluders(), 0);
  culler.dispose();
});

test('what comes and goes in groups is drawn while it is there and in view', async () => {
  const { scene, culler, frame } = await begin({ occlusion: false });
  let state = 7;
  const below = (n) => ((state = (Math.imul(state, 1664525) + 1013904223) >>> 0), Math.floor((state / 2 ** 32) * n));
  const make = (depth = 0) => {
    const kind = below(depth < 3 ? 4 : 3);
    if (kind === 0) return new THREE.Sprite();
    if (kind < 3) return meshAt(0, 0, kind === 1 ? -10 : 5000);
    const group = new THREE.Group();
    for (let i = below(4); i > 0; --i) group.add(make(depth + 1));
    group.visible = below(8) > 0;
    return group;
  };
  const groups = () => {
    const all = [];
    scene.traverse((each) => (each.isGroup || each.isScene) && all.push(each));
    return all;
  };
  let most = 0;
  for (let round = 0; round < 600; ++round) {
    const all = groups(), parent = all[below(all.length)], child = parent.children[below(parent.children.length)];
    const action = below(scene.children.length > 60 ? 4 : 10);
    if (action > 3) parent.add(make());
    else if (action === 3 && parent !== scene) parent.clear();
    else if (action === 2 && child?.isGroup) child.renderOrder = child.renderOrder ? 0 : 1; // three draws such ones by itself
    else if (action === 1 && child?.isMesh) (child.onAfterRender = below(2) ? () => {} : THREE.Mesh.prototype.onAfterRender);
    else if (child) parent.remove(child);
    const drawn = new Set(), there = new Set();
    for (const each of frame()) each.traverseVisible((one) => drawn.add(one));
    scene.traverseVisible((each) => (each.isMesh || each.isSprite) && there.add(each));
    for (const each of there) if (each.position.z < 0 || each.isSprite) assert.ok(drawn.has(each), `round ${round}: not drawn`);
    for (const each of drawn) if (each !== scene && !each.isGroup) assert.ok(there.has(each), `round ${round}: drawn, and not there`);
    most = Math.max(most, [...there].filter((each) => !drawn.has(each)).length);
  }
  assert.ok(most > 5, `${most} culled`);
  culler.dispose();
});
