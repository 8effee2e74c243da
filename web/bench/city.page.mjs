// In the page: how long render() keeps the main thread, with and without the culler, frame by frame in turns.
import * as THREE from 'three';
import { ready, SightlineCuller } from 'sightline-culling/three';
import { add, look, places, random } from '../scenes/city.mjs';

window.time = async (kind, count, aerial, frames, warm, unseen) => {
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
  const times = [[], []], whole = [[], []];
  let drawn = 0;
  // Compilers are done when frames have been gone through often; that nothing is drawn then lets it take seconds, not minutes.
  const show = (shown) => scene.traverse(({ material }) => material && (material.visible = shown));
  for (let frame = -warm - unseen; frame < frames; ++frame) {
    if (unseen > 0) show(frame >= -warm);
    if (aerial) camera.position.set(side / 2, 2 * side, side / 2), camera.lookAt(side / 2, 0, side / 2 + 1);
    else look(camera, next, side);
    for (const on of frame & 1 ? [0, 1] : [1, 0]) {
      for (let k = 0; k < moved; ++k) { // before each: both pay for what moves
        const i = moved === count ? k : Math.floor(next() * count), place = all[i];
        if (place.turn !== 0) move(i, { ...place, turn: 6 * next() });
      }
      culler.enabled = on === 1;
      const start = performance.now();
      renderer.render(scene, camera);
      const thread = performance.now() - start;
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel); // waits for the GPU
      if (frame >= 0) times[on].push(thread), whole[on].push(performance.now() - start);
    }
    if (frame >= 0) drawn += culler.stats.drawn / frames;
  }
  renderer.dispose(), renderer.forceContextLoss();
  return { whole, without: times[0], with: times[1], drawn: Math.round(drawn) };
};
