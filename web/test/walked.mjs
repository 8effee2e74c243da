// A scene under SightlineCuller in Node, where nothing is drawn: what three would walk.
import * as THREE from 'three';
import { ready, SightlineCuller } from 'sightline-culling/three';

const renderer = { isWebGLRenderer: true, sortObjects: true };

export const basic = () => new THREE.MeshBasicMaterial();
/** A box of this size. */
export function meshAt(x, y, z, size = [1, 1, 1], material = basic()) {
  const mesh = new THREE.Mesh(new THREE.BoxGeometry(...size), material);
  return mesh.position.set(x, y, z), mesh;
}

/** A scene with something behind the eye, lest all be in view and left to three; frame() returns what three walks. */
export async function begin(options, camera = new THREE.PerspectiveCamera(60, 1, 0.1, 1000)) {
  await ready;
  const scene = new THREE.Scene(), culler = new SightlineCuller(scene, options);
  scene.add(meshAt(0, 0, 5000));
  const frame = (look = () => {}) => {
    camera.updateMatrixWorld(), scene.updateMatrixWorld(), scene.onBeforeRender(renderer, scene, camera, null);
    const list = scene.children;
    look(), scene.onAfterRender(renderer, scene, camera);
    return list;
  };
  return { scene, camera, culler, frame };
}
