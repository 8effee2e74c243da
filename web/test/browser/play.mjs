// In a page: plays cases with scenes of three.js, without and with the culler, and compares what is drawn.
import * as THREE from 'three';
import { ready, SightlineCuller } from 'sightline-culling/three';

THREE.ColorManagement.enabled = false;
const width = 256, height = 144;

export const basic = (color, more) => new THREE.MeshBasicMaterial({ color, ...more });
export function box(x, y, z, color, size = 1, material = basic(color)) {
  const made = new THREE.Mesh(new THREE.BoxGeometry(size, size, size), material);
  made.position.set(x, y, z);
  return made;
}
/** All around, so that most is out of view. */
export const around = (i, far = 15) =>
  [Math.cos(2.4 * i) * (far + (i % 9) * 3), (i % 5) - 2, Math.sin(2.4 * i) * (far + (i % 9) * 3)];
export function scatter(scene, count = 60) {
  for (let i = 0; i < count; ++i) scene.add(box(...around(i, 25), (i * 1234567) & 0xffffff));
}

function differing(a, b) {
  let count = 0;
  for (let i = 0; i < a.length; i += 4) if (a[i] !== b[i] || a[i + 1] !== b[i + 1] || a[i + 2] !== b[i + 2]) ++count;
  return count;
}

// Pictures and what a case returns; how many frames dropped anything, and hid less than they had to.
async function play(run, renderer, isCulled) {
  const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(60, width / height, 0.1, 500), gl = renderer.getContext();
  const pictures = [], culler = isCulled ? new SightlineCuller(scene) : undefined;
  let culled = 0, shy = 0;
  await new Promise((loaded) => setTimeout(loaded, 20));
  const frame = () => {
    renderer.render(scene, camera);
    const picture = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, picture), pictures.push(picture);
    if (culler && culler.stats.drawn < culler.stats.objects) ++culled;
  };
  const hides = (least) => (shy += culler && culler.stats.hidden < least ? 1 : 0);
  renderer.shadowMap.enabled = false;
  const returned = await run({ scene, camera, renderer, frame, hides });
  culler?.dispose();
  return { pictures, returned, culled, shy };
}

/** By case: pixels that differ in each frame, what it returned without and with the culler, and what was culled. */
export async function playAll(cases) {
  await ready;
  const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true }), results = {};
  renderer.outputColorSpace = THREE.LinearSRGBColorSpace, renderer.setSize(width, height);
  for (const [name, run] of Object.entries(cases)) {
    const off = await play(run, renderer, false), on = await play(run, renderer, true);
    const differs = off.pictures.map((picture, i) => differing(picture, on.pictures[i]));
    results[name] = { differs, off: off.returned ?? null, on: on.returned ?? null, culled: on.culled, shy: on.shy };
  }
  renderer.dispose(), renderer.forceContextLoss();
  return results;
}
