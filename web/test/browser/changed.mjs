// In the page: what changes after it was first drawn, and what shaders and cameras do that boxes do not say, drawn with and
// without the culler.
import * as THREE from 'three';
import { around, basic, box, playAll, scatter } from './play.mjs';
import { walled } from './walls.mjs';

const matrix = new THREE.Matrix4(), red = 0xff0000;
const white = new THREE.DataTexture(new Uint8Array([255, 255, 255, 255]), 1, 1);
white.needsUpdate = true;

const instances = (count, material = basic(red)) => {
  const mesh = new THREE.InstancedMesh(new THREE.BoxGeometry(), material, count);
  for (let i = 0; i < count; ++i) mesh.setMatrixAt(i, matrix.makeTranslation(...around(i, 8)));
  return mesh;
};
// Instances that are not drawn at first, and stand elsewhere when they are.
const late = (hide, show) => ({ scene, camera, frame }) => {
  scatter(scene);
  const mesh = instances(20);
  for (let i = 0; i < 20; ++i) mesh.setMatrixAt(i, matrix.makeTranslation(0, 0, -6));
  hide(mesh), scene.add(mesh), frame();
  for (let i = 0; i < 20; ++i) mesh.setMatrixAt(i, matrix.makeTranslation(60 + i, 0, (i % 5) * 2));
  mesh.instanceMatrix.needsUpdate = true, show(mesh);
  frame(), (camera.rotation.y = -Math.PI / 2), frame(), frame();
};
// Boxes in a larger one, of which a camera that mirrors the world sees the inside.
const mirrored = (mirror) => ({ scene, camera, frame }) => {
  scatter(scene), scene.add(box(0, 0, -12, 0x808080, 10));
  for (let i = 0; i < 60; ++i) scene.add(box((i % 8) - 4, (i % 7) - 3, -12 + (i % 5) - 2, (i * 7654321) & 0xffffff, 0.5));
  mirror(camera, scene), frame(), frame();
};
const numbered = () => new THREE.ShaderMaterial({
  vertexShader: `varying float k; void main() { k = float(gl_InstanceID) / 100.0;
    gl_Position = projectionMatrix * modelViewMatrix * instanceMatrix * vec4(position, 1.0); }`,
  fragmentShader: 'varying float k; void main() { gl_FragColor = vec4(k, 1.0 - k, 0, 1); }' });
const patched = () => basic(red, { onBeforeCompile(shader) {
  shader.vertexShader = shader.vertexShader.replace('#include <begin_vertex>', 'vec3 transformed = position * (1.0 + 0.02 * float(gl_InstanceID));');
} });
const counted = (material) => ({ scene, camera, frame }) => {
  scatter(scene), scene.add(instances(100, material()));
  for (const turn of [0, 1, 2.5]) (camera.rotation.y = turn), frame();
};
const ground = ({ scene, camera }) => {
  const made = new THREE.Mesh(new THREE.PlaneGeometry(40, 40, 32, 32), new THREE.MeshStandardMaterial());
  scatter(scene), scene.add(made, new THREE.AmbientLight(0xffffff, 3));
  made.rotation.x = -Math.PI / 2, camera.position.set(0, 14, 10), camera.lookAt(0, 20, -30);
  return made.material;
};
const displaced = { displacementMap: white, displacementScale: 12 };
class Holes extends THREE.MeshBasicMaterial {
  onBeforeCompile(shader) {
    shader.fragmentShader = shader.fragmentShader.replace('void main() {', 'void main() { if (mod(gl_FragCoord.x, 8.0) < 4.0) discard;');
  }
}

const cases = {
  'instances that are hidden at first': late((mesh) => (mesh.visible = false), (mesh) => (mesh.visible = true)),
  'instances in another layer at first': late((mesh) => mesh.layers.set(2), (mesh) => mesh.layers.set(0)),
  'instances that are none at first': late((mesh) => (mesh.count = 0), (mesh) => (mesh.count = 20)),
  'instances that a shader counts': counted(numbered),
  'instances that a patched shader counts': counted(patched),
  'a projection that mirrors': mirrored((camera) => {
    camera.projectionMatrix.elements[0] *= -1, camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
  }),
  'a camera in a mirrored group': mirrored((camera, scene) => {
    const group = new THREE.Group();
    group.scale.x = -1, scene.add(group.add(camera));
  }),
  'a wall of a class whose shader has holes'({ scene, frame }) {
    walled(scene, new Holes({ color: 0x808080 })), scatter(scene), frame(), frame();
  },
  'a shader that writes a depth of its own'({ scene, frame, hides }) {
    walled(scene), scatter(scene);
    scene.add(box(0, 0, -20, red, 3, new THREE.ShaderMaterial({
      vertexShader: 'void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }',
      fragmentShader: 'void main() { gl_FragColor = vec4(1, 0, 0, 1); gl_FragDepth = 0.1; }' })));
    frame(), frame(), hides(50);
  },
  'a depth buffer that is emptied early'({ scene, frame }) {
    walled(scene).renderOrder = -2, scatter(scene);
    const empties = box(0, 4, -9, 0x00ff00, 0.1);
    empties.renderOrder = -1, (empties.onBeforeRender = (renderer) => renderer.clearDepth());
    scene.add(empties), frame(), frame();
  },
  'displacement that comes later'({ scene, camera, frame }) {
    const material = ground({ scene, camera });
    frame(), Object.assign(material, displaced, { needsUpdate: true }), frame(), frame();
  },
  'displacement that overrides'({ scene, camera, frame }) {
    ground({ scene, camera }), frame();
    scene.overrideMaterial = new THREE.MeshNormalMaterial(displaced), frame(), frame();
  },
  'morphs that come later'({ scene, frame }) {
    const mesh = new THREE.Mesh(new THREE.BoxGeometry(6, 1, 1), basic(red)), { geometry } = mesh;
    scatter(scene), scene.add(mesh), mesh.position.set(0, -6, -8), frame();
    const up = geometry.attributes.position.clone();
    for (let i = 0; i < up.count; ++i) up.setY(i, up.getY(i) + 2.5);
    geometry.morphAttributes.position = [up], mesh.updateMorphTargets(), (mesh.morphTargetInfluences[0] = 1);
    mesh.material.needsUpdate = true, geometry.dispose(), frame(), frame();
  },
  'rays after a mesh was deformed'({ scene, frame }) {
    const mesh = box(0, 0, -8, red), { position } = mesh.geometry.attributes;
    scatter(scene), scene.add(mesh), frame();
    for (let i = 0; i < position.count; ++i) position.setX(i, position.getX(i) + 5);
    position.needsUpdate = true, mesh.geometry.computeBoundingSphere(), frame(), frame();
    return new THREE.Raycaster(new THREE.Vector3(5, 0, 0), new THREE.Vector3(0, 0, -1)).intersectObject(mesh).length;
  },
};

window.play = () => playAll(cases);
