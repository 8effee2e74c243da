// In the page: a scene whose owner does things to it, too, drawn with and without the culler.
import * as THREE from 'three';
import { random } from '../../scenes/city.mjs';
import { around, basic, box, playAll, scatter } from './play.mjs';

const matrix = new THREE.Matrix4();

function light(scene, renderer) {
  const sun = new THREE.DirectionalLight(0xffffff, 2);
  sun.position.set(20, 60, 10), (sun.castShadow = true);
  Object.assign(sun.shadow.camera, { left: -60, right: 60, top: 60, bottom: -60, far: 200 });
  scene.add(sun), (renderer.shadowMap.enabled = true);
  return sun;
}
function instances(count) {
  const made = new THREE.InstancedMesh(new THREE.BoxGeometry(), basic(0xffffff), count);
  for (let i = 0; i < count; ++i) made.setMatrixAt(i, matrix.makeTranslation(...around(i, 10)));
  return made;
}
// Something in view that does a thing once, while it is drawn.
function once(scene, does) {
  const made = box(0, 0, -8, 0xffffff);
  made.onBeforeRender = () => ((made.onBeforeRender = () => {}), does());
  scene.add(made);
}
const namesOf = ({ children }) => children.map(({ name }) => name).filter((name) => name).sort();

function changesWhileDrawn({ scene, camera, frame }) {
  scatter(scene);
  const culled = box(0, 0, 30, 0xff00ff, 5), shown = box(-2, 0, -8, 0x00ff00), child = box(0, 2, -8, 0x0000ff), other = new THREE.Group();
  Object.entries({ culled, shown, child, other }).forEach(([name, object]) => (object.name = name));
  scene.add(culled, shown, other.add(child));
  const parents = [];
  once(scene, () => {
    const added = box(2, 0, -8, 0xff0000);
    scene.remove(culled), scene.add((added.name = 'added', added)), scene.attach(child), other.add(shown);
    parents.push(culled.parent, scene.children.indexOf(added) >= 0);
  });
  frame(), frame();
  camera.rotation.y = Math.PI, frame();
  return [namesOf(scene), namesOf(other), culled.parent === null];
}

const cases = {
  'shadows of a light whose camera nobody has brought up to date'({ scene, camera, renderer, frame }) {
    const { shadow } = light(scene, renderer), lit = new THREE.MeshLambertMaterial({ color: 0xff8800 });
    shadow.mapSize.set(512, 512), (shadow.autoUpdate = false), (shadow.needsUpdate = true);
    const ground = new THREE.Mesh(new THREE.PlaneGeometry(120, 120).rotateX(-Math.PI / 2), lit);
    scene.add(ground), (ground.receiveShadow = true);
    for (let i = 0; i < 60; ++i) {
      const house = box((i % 10) * 9 - 40, 2, Math.floor(i / 10) * 9 - 25, 0, 4, lit);
      scene.add(house), (house.castShadow = true);
    }
    camera.position.set(0, 15, 40), camera.lookAt(0, 0, 0);
    frame(), frame();
    camera.rotation.y += 1, frame();
  },
  'instances that no shadow is drawn of any longer'({ scene, camera, renderer, frame }) {
    const { shadowMap } = renderer, { shadow, position, target } = light(scene, renderer), mesh = instances(100);
    mesh.castShadow = true, scene.add(mesh), scene.add(target);
    // Just before fewer are shown than the light sees, and before all are.
    const stops = [[() => (shadowMap.autoUpdate = false), () => (shadowMap.autoUpdate = true)],
      [() => (shadowMap.enabled = false), () => (shadowMap.enabled = true)],
      [() => (shadow.autoUpdate = false), () => (shadow.autoUpdate = true)],
      [() => (mesh.castShadow = false), () => (mesh.castShadow = true)],
      [() => (position.x += 500, target.position.x += 500), () => (position.x -= 500, target.position.x -= 500)]];
    for (const [i, [stop, start]] of stops.entries()) {
      for (const above of [0, 60]) {
        const reach = above ? 10 : 60;
        Object.assign(shadow.camera, { left: -reach, right: reach, top: reach, bottom: -reach }).updateProjectionMatrix();
        mesh.instanceMatrix = mesh.instanceMatrix.clone();
        camera.position.set(0, 0, 0), camera.rotation.set(0, i, 0), frame();
        stop(), camera.position.set(0, above, 0), above ? camera.lookAt(0, 0, 0) : camera.rotation.set(0, i + 2, 0);
        frame(), frame(), start();
      }
    }
  },
  'children that come and go while the scene is drawn': changesWhileDrawn,
  'children that come and go while shadows are drawn, too'(given) {
    light(given.scene, given.renderer);
    return changesWhileDrawn(given);
  },
  'all children taken out while the scene is drawn'({ scene, frame }) {
    scatter(scene), once(scene, () => scene.clear());
    frame(), frame();
    return scene.children.length;
  },
  async 'another onAfterRender'({ scene, camera, frame }) {
    scatter(scene), (scene.onAfterRender = () => {});
    frame(), frame();
    await Promise.resolve();
    const { length } = scene.children;
    camera.rotation.y = 2, frame();
    return length;
  },
  'lists of children that somebody writes'({ scene, camera, frame }) {
    scatter(scene);
    const group = new THREE.Group().add(box(0, 0, -8, 0xffffff)), more = box(2, 0, -8, 0xff0000);
    scene.add(group), frame();
    group.children.push(more), (more.parent = group), frame();
    group.add(box(-2, 0, -8, 0x00ff00)), frame();
    group.children = [], frame();
    scene.children = scene.children.filter((_, i) => i % 2), frame();
    camera.rotation.y = 1, frame();
  },
  'colours of instances in bytes'({ scene, camera, frame }) {
    const mesh = instances(300), colours = Uint8Array.from({ length: 900 }, (_, i) => 37 * i);
    mesh.instanceColor = new THREE.InstancedBufferAttribute(colours, 3, true);
    scene.add(mesh), frame();
    camera.rotation.y = 1, frame();
    mesh.instanceColor = new THREE.InstancedBufferAttribute(Float32Array.from(colours, (x) => 1 - x / 255), 3), frame();
  },
  'a class of batches with a callback of its own'({ scene, camera, frame }) {
    let calls = 0;
    class Red extends THREE.BatchedMesh {
      onBeforeRender(...all) {
        ++calls, this.material.color.setHex(0xff0000);
        super.onBeforeRender(...all);
      }
    }
    const batch = new Red(100, 100, 200, basic(0xffffff)), shape = batch.addGeometry(new THREE.BoxGeometry());
    for (let i = 0; i < 100; ++i) batch.setMatrixAt(batch.addInstance(shape), matrix.makeTranslation(...around(i)));
    scatter(scene), scene.add(batch), frame();
    camera.rotation.y = 1, frame();
    return calls;
  },
  'callbacks that change an InstancedMesh'({ scene, camera, renderer, frame }) {
    const mesh = instances(100), seen = [];
    light(scene, renderer), scene.add(mesh), (mesh.castShadow = true);
    mesh.onBeforeRender = () => {
      seen.push(mesh.count, mesh.instanceMatrix.count);
      mesh.setMatrixAt(99, matrix.makeTranslation(seen.length / 2, 0, -9)), (mesh.instanceMatrix.needsUpdate = true);
    };
    mesh.onAfterRender = mesh.onBeforeShadow = mesh.onAfterShadow = () => seen.push(mesh.count);
    frame(), frame();
    mesh.onBeforeRender = () => ((mesh.onBeforeRender = () => seen.push('other')), (mesh.count = 50));
    frame(), frame();
    camera.rotation.y = 1, frame();
    return seen;
  },
  'callbacks of what three alone takes to be in view'({ scene, camera, frame }) {
    // Its sphere reaches into view, its box does not; a screen in view shows what its callback has drawn.
    const long = new THREE.BoxGeometry(0.2, 30, 0.2), calls = [], shown = box(0, 0, -8, 0xff0000, 3);
    const many = new THREE.InstancedMesh(long, basic(0xffffff), 1), batch = new THREE.BatchedMesh(1, 100, 200, basic(0xffffff));
    batch.setMatrixAt(batch.addInstance(batch.addGeometry(long)), matrix.makeTranslation(0, 0, 0)), many.setMatrixAt(0, matrix);
    for (const [i, mesh] of [new THREE.Mesh(long, basic(0xffffff)), many, batch].entries()) {
      mesh.onBeforeRender = () => (calls.push(i), shown.material.color.offsetHSL(0.11, 0, 0));
      mesh.position.set(i === 1 ? -8.6 : 8.6, 0, -6), mesh.renderOrder = -1, scene.add(mesh);
    }
    scatter(scene), scene.add(shown);
    for (let view = 0; view < 8; ++view) camera.rotation.y = 0.02 * (view - 4), frame();
    return calls;
  },
};

// Round shapes, whose seams meet to within a rounding.
const { CapsuleGeometry, ConeGeometry, CylinderGeometry, LatheGeometry, SphereGeometry, Vector2 } = THREE;
const profile = [[0, -2], [2, -2], [2, 2], [0, 2]].map(([x, y]) => new Vector2(x, y));
const shapes = { cylinder: new CylinderGeometry(2, 2, 4, 16), cone: new ConeGeometry(2, 4, 16), sphere: new SphereGeometry(2, 12, 8),
  capsule: new CapsuleGeometry(1, 2, 3, 8), lathe: new LatheGeometry(profile, 12) };
for (const [name, geometry] of Object.entries(shapes)) {
  cases[`what a ${name} hides`] = ({ scene, camera, frame, hides }) => {
    const next = random(7), shape = new THREE.Mesh(geometry, basic(0x808080));
    scene.add(shape);
    for (let i = 0; i < 400; ++i) scene.add(box((next() - 0.5) * 24, (next() - 0.5) * 24, -3 - 12 * next(), (i * 1234567) & 0xffffff, 0.3));
    for (let view = 0; view < 12; ++view) {
      camera.position.set((next() - 0.5) * 4, (next() - 0.5) * 4, 4 + 3 * next()), camera.lookAt(0, 0, 0);
      shape.rotation.set(3 * next(), 3 * next(), 3 * next());
      frame(), hides(10);
    }
  };
}

window.play = () => playAll(cases);
