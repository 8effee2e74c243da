// In the page: what shows elsewhere than its points say, or through others, drawn with and without the culler.
import * as THREE from 'three';
import { Reflector } from 'three/examples/jsm/objects/Reflector.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { basic, box, playAll, scatter } from './play.mjs';
import { walled } from './walls.mjs';

const white = new THREE.DataTexture(new Uint8Array([255, 255, 255, 255]), 1, 1);
white.needsUpdate = true;

// A wall that stops hiding by what `changes` does to it, after a frame in which it hides.
const unwalled = (changes) => ({ scene, frame, hides }) => {
  const wall = walled(scene);
  frame(), frame(), hides(50);
  changes(wall, scene), frame(), frame();
};
// A mesh in view by what `moves` does to its points in the shader, or says of them.
const seen = (make) => ({ scene, camera, frame }) => {
  scatter(scene);
  const mesh = make();
  scene.add(mesh, new THREE.AmbientLight(0xffffff, 3));
  frame(), frame();
  camera.rotation.y = 1, frame();
};
const shader = () => new THREE.ShaderMaterial({ side: THREE.DoubleSide,
  vertexShader: 'void main() { gl_Position = projectionMatrix * viewMatrix * (modelMatrix * vec4(position, 1.0) - vec4(0, 0, 30, 0)); }',
  fragmentShader: 'void main() { gl_FragColor = vec4(1, 0, 0, 1); }' });
const lines = (points) => {
  const made = new LineSegments2(new LineSegmentsGeometry().setPositions(points), new LineMaterial({ color: 0xff0000, linewidth: 20 }));
  made.material.resolution.set(256, 144);
  return made;
};

const cases = {
  'terrain that a map displaces'({ scene, camera, frame }) {
    scatter(scene), scene.add(new THREE.AmbientLight(0xffffff, 3));
    const material = new THREE.MeshStandardMaterial({ displacementMap: white, displacementScale: 12 });
    const ground = new THREE.Mesh(new THREE.PlaneGeometry(40, 40, 32, 32), material);
    ground.rotation.x = -Math.PI / 2, scene.add(ground);
    camera.position.set(0, 14, 10), camera.lookAt(0, 20, -30), frame(), frame();
    ground.material = new THREE.MeshStandardMaterial({ displacementMap: white, displacementScale: -2 }), frame();
    camera.rotation.y = 1, frame();
  },
  'a bounding sphere made large for a shader': seen(() => {
    const mesh = new THREE.Mesh(new THREE.BoxGeometry(9, 9, 1), shader());
    mesh.geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(), 100), mesh.position.set(0, 0, 10);
    return mesh;
  }),
  'a bounding sphere made large later'({ scene, frame }) {
    scatter(scene);
    const mesh = new THREE.Mesh(new THREE.BoxGeometry(9, 9, 1), shader());
    mesh.position.set(0, 0, 10), scene.add(mesh), frame();
    mesh.geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(), Infinity), frame(), frame();
  },
  'points that are newer than their box': seen(() => {
    const mesh = box(0, 0, 0, 0xff0000, 2), { geometry } = mesh;
    geometry.computeBoundingBox(), geometry.translate(0, 0, -9);
    geometry.boundingBox = new THREE.Box3(new THREE.Vector3(-1, -1, 20), new THREE.Vector3(1, 1, 22));
    return mesh;
  }),
  'wide lines whose points are set anew'({ scene, frame }) {
    scatter(scene);
    const line = lines([-3, 0, 20, 3, 0, 20]);
    scene.add(line), frame();
    line.geometry.setPositions([-3, 0, -9, 3, 1, -9]), line.geometry.computeBoundingSphere(), frame();
  },
  'a mirror on the floor, and occlusion'({ scene, camera, frame }) {
    walled(scene), scatter(scene, 100);
    for (let i = 0; i < 20; ++i) scene.add(box(-10 + i, -6, -14, (0x123456 * (i + 1)) & 0xffffff, 3));
    const floor = new Reflector(new THREE.PlaneGeometry(60, 60), { textureWidth: 256, textureHeight: 256 });
    floor.rotation.x = -Math.PI / 2, (floor.position.y = -4), scene.add(floor);
    camera.position.set(0, 3, 8), frame();
    camera.position.set(3, 1, 8), frame();
    camera.position.set(1, 2, -15), frame();
  },
  'what is drawn over all'({ scene, frame }) {
    walled(scene), scatter(scene);
    const ball = new THREE.Mesh(new THREE.SphereGeometry(2), basic(0xff0000)), later = box(3, 0, -20, 0x00ff00, 2);
    ball.position.z = -20, (ball.renderOrder = 999), (ball.onBeforeRender = (renderer) => renderer.clearDepth());
    later.renderOrder = 1000, scene.add(ball, later);
    frame(), frame();
  },
  'transparent things after the depth buffer was emptied'({ scene, frame, hides }) {
    const wall = walled(scene), glass = basic(0xff0000, { transparent: true, opacity: 0.5 }), behind = box(0, 0, -20, 0, 3, glass);
    const empties = (renderer) => renderer.clearDepth(), gizmo = box(3, 3, -9, 0x00ff00, 0.3), far = box(0, 4, -60, 0x00ff00, 1);
    far.material.transparent = true, scatter(scene), scene.add(behind), frame(), hides(101);
    gizmo.renderOrder = 999, (gizmo.onBeforeRender = empties), scene.add(gizmo), frame(), hides(100);
    gizmo.onBeforeRender = THREE.Mesh.prototype.onBeforeRender, (gizmo.material.onBeforeRender = empties), frame(), hides(100);
    scene.remove(gizmo), (far.onAfterRender = empties), scene.add(far), frame(), hides(100);
    scene.remove(far);
    const many = new THREE.InstancedMesh(gizmo.geometry, basic(0x00ff00), 1);
    many.setMatrixAt(0, new THREE.Matrix4()), many.position.set(3, 3, -9), (many.renderOrder = 1), (many.onBeforeRender = empties);
    scene.add(many), frame(), hides(100);
    glass.transmission = 1, (glass.transparent = false), frame();
    return wall.visible;
  },
  'a wall that moves as it is drawn'({ scene, frame }) {
    const wall = walled(scene);
    scatter(scene), (wall.onBeforeRender = () => wall.matrixWorld.makeTranslation(0, 30, -10));
    frame(), frame();
  },
  'callbacks of materials'({ scene, camera, frame }) {
    // One moves a wall, one colours what is in view, as often as it is called for what is hidden, one by what it empties, too.
    const wall = walled(scene), shown = box(0, 0, -8, 0xff0000, 3), hidden = box(0, 0, -20, 0xff0000, 3), calls = [];
    const moves = (r, s, c, g, object) => object.modelViewMatrix.makeTranslation(0, 30, -10);
    hidden.material.onBeforeRender = () => (calls.push(1), shown.material.color.offsetHSL(0.11, 0, 0));
    hidden.renderOrder = -3, scatter(scene), scene.add(shown, hidden), frame(), frame();
    wall.material.onBeforeRender = moves, frame(), frame();
    delete wall.material.onBeforeRender, (wall.renderOrder = -2), frame();
    const empties = box(0, 4, -9, 0x00ff00, 0.1);
    empties.renderOrder = -1, (empties.material.onBeforeRender = (renderer) => renderer.clearDepth());
    scene.remove(hidden), scene.add(empties), frame(), frame();
    scene.overrideMaterial = basic(0x00ffff), (scene.overrideMaterial.onBeforeRender = () => calls.push(2)), frame();
    return calls;
  },
  'a wall whose material is invisible, and an override': unwalled((wall, scene) => {
    wall.material.visible = false, (scene.overrideMaterial = basic(0x00ffff));
  }),
  'a wall that allows no override': unwalled((wall, scene) => {
    Object.assign(wall.material, { transparent: true, opacity: 0.3, allowOverride: false }), (wall.material.needsUpdate = true);
    scene.overrideMaterial = basic(0x00ffff);
  }),
  'a wall that lacks faces, and an override': unwalled((wall, scene) => {
    wall.material = [basic(0xffffff)], (scene.overrideMaterial = basic(0x00ffff));
  }),
  'a marked wall that lets light through': unwalled((wall) => {
    wall.userData.occluder = true, Object.assign(wall.material, { transparent: true, opacity: 0.3, needsUpdate: true });
  }),
  'a marked wall with holes': unwalled((wall) => {
    const image = Uint8Array.from({ length: 256 }, (_, i) => (i % 4 === 3 && Math.floor(i / 4) % 2 ? 0 : 255));
    const map = new THREE.DataTexture(image, 8, 8);
    map.needsUpdate = true, (wall.userData.occluder = new THREE.BoxGeometry(19, 9, 0.5));
    Object.assign(wall.material, { map, alphaTest: 0.5, needsUpdate: true });
  }),
  'a marked wall of several materials'({ scene, frame, hides }) {
    const wall = walled(scene), { geometry } = wall, { groups } = geometry, gray = basic(0x808080);
    const of = (count) => new Array(count).fill(gray);
    scatter(scene), (wall.userData.occluder = true), (wall.material = of(6)), frame(), hides(50);
    geometry.groups = [{ start: 0, count: Infinity, materialIndex: 5 }], frame(), hides(50);
    geometry.groups = groups, (wall.material = of(4)), frame(); // which leaves the front out
    wall.material = of(6), (geometry.groups = groups.filter(({ start }) => start !== 24)), frame();
    wall.userData.occluder = new THREE.BoxGeometry(19, 9, 0.5), frame();
    wall.userData.occluder = true, geometry.clearGroups(), frame();
  },
  'a marked wall that is not drawn': unwalled((wall) => (wall.userData.occluder = true, wall.material.visible = false)),
  'instances that gain an attribute'({ scene, camera, frame }) {
    const count = 60, mesh = new THREE.InstancedMesh(new THREE.BoxGeometry(), shader(), count), matrix = new THREE.Matrix4();
    mesh.material.vertexShader = `attribute float hue; varying float shade;
      void main() { shade = hue; gl_Position = projectionMatrix * modelViewMatrix * instanceMatrix * vec4(position, 1.0); }`;
    mesh.material.fragmentShader = 'varying float shade; void main() { gl_FragColor = vec4(shade, 1.0 - shade, 0, 1); }';
    for (let i = 0; i < count; ++i) mesh.setMatrixAt(i, matrix.makeTranslation((i % 12) - 6, (i % 5) - 2, i % 2 ? -12 : 12));
    scatter(scene), scene.add(mesh), frame();
    const hues = Float32Array.from({ length: count }, (_, i) => i / count);
    mesh.geometry.setAttribute('hue', new THREE.InstancedBufferAttribute(hues, 1)), frame(), frame();
    camera.rotation.y = 2, frame();
  },
  'a mesh that is left alone later'({ scene, frame }) {
    scatter(scene);
    const mesh = new THREE.Mesh(new THREE.BoxGeometry(9, 9, 1), shader());
    mesh.geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(), 5), mesh.position.set(0, 0, 5), scene.add(mesh), frame();
    mesh.userData.sightline = false, (mesh.frustumCulled = true), frame();
    mesh.geometry.boundingSphere.radius = 100, frame();
  },
};

window.play = () => playAll(cases);
