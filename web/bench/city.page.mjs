// In the page: how long render() keeps the main thread, and until all is drawn, with and without the culler, frame by frame in turns.
import * as THREE from 'three';
import { ready, SightlineCuller } from 'sightline-culling/three';
import { add, look, places, random } from '../scenes/city.mjs';

// Where all of a city is in view SwiftShader would draw on the same cores for seconds: three asks for all of it, and nothing is
// drawn.
const drawing = (gl) => [[gl, 'drawElements'], [gl, 'drawElementsInstanced'],
  [gl.getExtension('WEBGL_multi_draw'), 'multiDrawElementsWEBGL']];
const leaveOut = (gl) => drawing(gl).forEach(([object, name]) => (object[name] = () => {}));
const putBack = (gl) => drawing(gl).forEach(([object, name]) => delete object[name]);

window.time = async (kind, count, aerial, { warm, timed, drawn }) => {
  await ready;
  const renderer = new THREE.WebGLRenderer({ antialias: true });
  renderer.setSize(256, 144);
  const scene = new THREE.Scene(), { all, side } = places(count);
  const set = add(scene, kind === 'batched' || kind === 'meshes' ? kind : 'instanced', all, new THREE.MeshBasicMaterial());
  const [{ instanceMatrix }] = scene.children;
  const move = kind === 'ranges' ? (i, place) => (set(i, place), instanceMatrix.addUpdateRange(16 * i, 16)) : set;
  const moved = kind === 'restless' ? count : count / 1000;
  const camera = new THREE.PerspectiveCamera(60, 16 / 9, 0.1, aerial ? 20000 : 1000), next = random(3);
  const culler = new SightlineCuller(scene), gl = renderer.getContext(), pixel = new Uint8Array(4);
  await new Promise((loaded) => setTimeout(loaded, 100));
  const thread = [[], []], whole = [[], []];
  let kept = 0;
  for (let frame = -warm; frame < timed + drawn; ++frame) {
    if (aerial) camera.position.set(side / 2, 2 * side, side / 2), camera.lookAt(side / 2, 0, side / 2 + 1);
    else look(camera, next, side);
    if (aerial && frame < timed) leaveOut(gl);
    else putBack(gl);
    for (const on of frame & 1 ? [0, 1] : [1, 0]) {
      for (let k = 0; k < moved; ++k) { // before each: both pay for what moves
        const i = moved === count ? k : Math.floor(next() * count), place = all[i];
        if (place.turn !== 0) move(i, { ...place, turn: 6 * next() });
      }
      culler.enabled = on === 1;
      const start = performance.now();
      renderer.render(scene, camera);
      if (frame >= 0 && frame < timed) thread[on].push(performance.now() - start);
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel); // waits for the GPU
      if (frame >= timed) whole[on].push(performance.now() - start);
    }
    if (frame >= 0) kept += culler.stats.drawn / (timed + drawn);
  }
  renderer.dispose(), renderer.forceContextLoss();
  return { thread, whole, kept: Math.round(kept) };
};
