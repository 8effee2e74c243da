// In the page: views with and without the culler, compared to the bit.
import * as THREE from 'three';
import { ready, SightlineCuller } from 'sightline-culling/three';
import { add, look, places, random } from '../../scenes/city.mjs';

THREE.ColorManagement.enabled = false;
const width = 256, height = 144;

function pixels(renderer, scene, camera) {
  renderer.render(scene, camera);
  const gl = renderer.getContext(), out = new Uint8Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, out);
  return out;
}
const differing = (a, b) => {
  let count = 0;
  for (let i = 0; i < a.length; i += 4) if (a[i] !== b[i] || a[i + 1] !== b[i + 1] || a[i + 2] !== b[i + 2]) ++count;
  return count;
};

const colour = new THREE.Color();
function colourOf({ object, instanceId, batchId }) {
  if (instanceId !== undefined) object.getColorAt(instanceId, colour);
  else if (batchId !== undefined) object.getColorAt(batchId, colour);
  else colour.copy(object.material.color);
  return colour.toArray().map((x) => Math.round(255 * x));
}

// Where in a pixel rays are cast: in a grid, and at and about each of the four samples, whichever way up.
const inPixel = Array.from({ length: 64 }, (_, k) => [((k % 8) + 0.5) / 8, (Math.floor(k / 8) + 0.5) / 8]);
for (const [x, y] of [[3, 1], [7, 3], [1, 5], [5, 7]]) {
  for (const up of [y / 8, 1 - y / 8])
    for (let k = 0; k < 9; ++k) inPixel.push([x / 8 + ((k % 3) - 1) / 64, up + (Math.floor(k / 3) - 1) / 64]);
}

// Whether a pixel can be the mean of four samples of the colours.
function isMean(pixel, colours) {
  const add = (sum, left, from) => (left === 0 ? sum.every((x, i) => Math.abs(x / 4 - pixel[i]) <= 1)
    : colours.slice(from).some((one, k) => add(sum.map((x, i) => x + one[i]), left - 1, from + k)));
  return add([0, 0, 0], 4, 0);
}

// Rasterisers that clip triangles one by one leave a gap of a sample between two of one face now and then, and are wrong about
// the depth of one that is seen edge on: three then shows what a wall hides. Such a pixel is no loss: what the culler drew is
// made of what exact rays through it meet first, and what three drew is not.
function isGap(scene, camera, pixel, before, after) {
  const x = pixel % width, y = Math.floor(pixel / width), ray = new THREE.Raycaster(), first = new Map();
  ray.layers.enableAll();
  const isShown = (object) => !object || (object.visible && isShown(object.parent));
  for (const [right, up] of inPixel) {
    ray.setFromCamera(new THREE.Vector2(((x + right) / width) * 2 - 1, ((y + up) / height) * 2 - 1), camera);
    const hit = ray.intersectObjects(scene.children).find(({ object }) => isShown(object) && object.layers.test(camera.layers));
    const met = hit ? colourOf(hit) : [0, 0, 0]; // nothing is black
    first.set(met.join(), met);
  }
  const colours = [...first.values()], of = (picture) => [...picture.slice(4 * pixel, 4 * pixel + 3)];
  return isMean(of(after), colours) && !isMean(of(before), colours);
}

// Draws things in their own colours, without light and what is seen through, until what it returns is called.
function plain(scene) {
  const undo = [];
  scene.traverse((object) => {
    if (!object.isMesh) return;
    const { material, visible } = object;
    object.material = new THREE.MeshBasicMaterial({ color: material.color });
    object.visible = visible && object.name === '';
    undo.push(() => (object.material.dispose(), Object.assign(object, { material, visible })));
  });
  return () => undo.forEach((each) => each());
}

/** Pixels that the culler lost, and gaps, of those that differ between two pictures of a view. */
function judge(renderer, scene, camera, culler, [off, on]) {
  const undo = plain(scene);
  culler.enabled = false;
  const before = pixels(renderer, scene, camera);
  culler.enabled = true;
  const after = pixels(renderer, scene, camera);
  let lost = 0, gaps = 0;
  for (let p = 0; p < width * height; ++p) {
    if (![0, 1, 2].some((c) => off[4 * p + c] !== on[4 * p + c])) continue;
    if (isGap(scene, camera, p, before, after)) ++gaps;
    else ++lost;
  }
  undo();
  return { lost, gaps };
}

function makeScene(lit) {
  const scene = new THREE.Scene();
  const { all, side } = places(1500);
  const material = lit ? new THREE.MeshLambertMaterial() : new THREE.MeshBasicMaterial();
  const kinds = ['instanced', 'batched', 'meshes'];
  const movers = kinds.map((kind, k) => add(scene, kind, all.filter((_, i) => i % 3 === k), material, 5000 * k));
  for (const child of scene.children) child.castShadow = child.receiveShadow = true;
  const glass = new THREE.Mesh(new THREE.BoxGeometry(6, 9, 6), new THREE.MeshBasicMaterial({
    color: 0x3050ff, transparent: true, opacity: 0.5, side: THREE.DoubleSide }));
  glass.position.set(12, 4, 12);
  const marker = new THREE.Mesh(new THREE.ConeGeometry(1, 2), new THREE.MeshBasicMaterial({ color: 0xff00ff, depthTest: false, depthWrite: false }));
  glass.name = 'glass', (marker.name = 'marker');
  marker.position.set(60, 3, 60);
  scene.add(glass, marker, new THREE.AmbientLight(0xffffff, 0.5));
  if (lit) {
    const sun = new THREE.DirectionalLight(0xffffff, 1);
    sun.position.set(30, 60, 20), (sun.castShadow = true);
    Object.assign(sun.shadow.camera, { left: -80, right: 80, top: 80, bottom: -80, far: 200 });
    const lamp = new THREE.PointLight(0xffeecc, 300);
    lamp.position.set(36, 6, 36), (lamp.castShadow = true);
    scene.add(sun, lamp);
  }
  return { scene, side, movers, all };
}

/** Draws `count` views of a scene in which things move, both ways; says what was lost and what was culled. */
window.compare = async (count, { lit, antialias, reach = 0.1, aerial = 4 }) => {
  await ready;
  const renderer = new THREE.WebGLRenderer({ antialias, preserveDrawingBuffer: true });
  renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
  renderer.setSize(width, height), (renderer.shadowMap.enabled = lit);
  const { scene, side, movers, all } = makeScene(lit);
  const camera = new THREE.PerspectiveCamera(70, width / height, reach, 500);
  const culler = new SightlineCuller(scene);
  await new Promise((loaded) => setTimeout(loaded, 50));
  const next = random(7);
  const result = { lost: 0, gaps: 0, objects: 0, drawn: 0, hidden: 0, frames: 0, callsOff: 0, callsOn: 0, shown: 0 };
  for (let v = 0; v < count; ++v) {
    look(camera, next, side, v % aerial === 0 ? 60 : 1.6);
    movers.forEach((move, k) => {
      const i = Math.floor(next() * (all.length / 3)), place = all[3 * i + k];
      if (place.turn !== 0) move(i, { ...place, at: [next() * side, place.size[1] / 2, next() * side] });
    });
    culler.enabled = false;
    const before = pixels(renderer, scene, camera);
    result.callsOff += renderer.info.render.triangles;
    culler.enabled = true;
    const after = pixels(renderer, scene, camera);
    result.callsOn += renderer.info.render.triangles;
    if (differing(before, after) > 0) {
      const { lost, gaps } = judge(renderer, scene, camera, culler, [before, after]);
      result.lost += lost, (result.gaps += gaps);
    }
    result.shown += before.some((x, i) => i % 4 < 3 && x > 0) ? 1 : 0;
    for (const key of ['objects', 'drawn', 'hidden']) result[key] += culler.stats[key];
    ++result.frames;
  }
  result.children = scene.children.length;
  culler.dispose();
  result.disposed = differing(pixels(renderer, scene, camera), (renderer.render(scene, camera), pixels(renderer, scene, camera)));
  renderer.dispose(), renderer.forceContextLoss();
  return result;
};

function stretch(geometry, by) {
  const { position } = geometry.attributes;
  for (let i = 0; i < position.count; ++i) position.setY(i, by * position.getY(i));
  position.needsUpdate = true, geometry.computeBoundingSphere();
}
// Lifts instances first … end - 1, as nothing in three is told.
function raise(matrices, first, end) {
  for (let i = first; i < end; ++i) matrices[16 * i + 13] += 15;
}

/** From where all is in view, three draws its own scene; from the street again less. */
window.above = async () => {
  await ready;
  const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
  renderer.setSize(width, height);
  const { scene, side, movers, all } = makeScene(false), own = scene.children;
  const camera = new THREE.PerspectiveCamera(70, width / height, 0.1, 4000), next = random(5);
  const culler = new SightlineCuller(scene, { occlusion: false }), result = { differing: 0, own: 0, whole: 0, street: 0 };
  await new Promise((loaded) => setTimeout(loaded, 50));
  let listed;
  scene.children[1].material.onBeforeRender = () => (listed = scene.children);
  for (let v = 0; v < 12; ++v) {
    camera.position.set(side / 2, 2 * side + v, side / 2), camera.lookAt(side / 2, 0, side / 2 + 1);
    movers.forEach((move, k) => {
      const i = 3 * Math.floor(next() * (all.length / 3)) + k;
      // What leaves the box that all was in is drawn as well.
      if (all[i].turn !== 0) move(Math.floor(i / 3), { ...all[i], at: [next() * side, v === 6 ? 90 : 1, next() * side] });
    });
    culler.enabled = false;
    const before = pixels(renderer, scene, camera);
    culler.enabled = true;
    result.differing += differing(before, pixels(renderer, scene, camera));
    result.own += listed === own ? 1 : 0;
    result.whole += culler.stats.drawn === culler.stats.objects ? 1 : 0;
  }
  camera.position.set(12, 2, 45), camera.rotation.set(0, 0, 0);
  pixels(renderer, scene, camera);
  result.street = culler.stats.drawn / culler.stats.objects;
  renderer.dispose(), renderer.forceContextLoss();
  return result;
};

/** Frame after frame with the culler alone, in which instances of a batch move, some also while they are drawn; then each view as
 * three draws it. Pictures that differ, and how often all matrices were sent, or some. */
window.batch = async (views) => {
  await ready;
  const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
  renderer.setSize(width, height);
  const scene = new THREE.Scene(), { all, side } = places(1500), move = add(scene, 'batched', all, new THREE.MeshBasicMaterial());
  const camera = new THREE.PerspectiveCamera(70, width / height, 0.1, 500), next = random(9), gl = renderer.getContext();
  const culler = new SightlineCuller(scene, { occlusion: false }), result = { differing: [], whole: 0, some: 0, moved: 0 };
  const { width: texels } = scene.children[0]._matricesTexture.image, send = gl.texSubImage2D;
  gl.texSubImage2D = function (...given) {
    if (culler.enabled && given[7] === gl.FLOAT) ++result[given[4] === texels ? 'whole' : 'some'];
    return send.apply(this, given);
  };
  const moveSome = (most) => {
    for (let left = Math.floor(most * next()); left > 0; --left) {
      const i = Math.floor(next() * all.length);
      all[i] = { ...all[i], at: [next() * side, all[i].size[1] / 2, next() * side] };
      move(i, all[i]), ++result.moved;
    }
  };
  let whileDrawn = false;
  scene.children[0].material.onBeforeRender = () => whileDrawn && moveSome(3);
  await new Promise((loaded) => setTimeout(loaded, 50));
  for (let v = 0; v < views; ++v) {
    culler.enabled = true;
    for (let frame = 0; frame < 6; ++frame) {
      look(camera, next, side, v % 5 === 0 ? 60 : 1.6), moveSome(v % 7 === 0 ? 700 : 20);
      whileDrawn = v % 3 === 0 && frame % 2 === 0;
      renderer.render(scene, camera);
    }
    whileDrawn = false, moveSome(20);
    const after = pixels(renderer, scene, camera);
    culler.enabled = false;
    if (differing(pixels(renderer, scene, camera), after) > 0) result.differing.push(v);
    if (v === views >> 1) { // as a browser takes contexts away
      const lost = gl.getExtension('WEBGL_lose_context'), { log } = console;
      console.log = () => {}; // three's own words
      lost.loseContext(), await new Promise((gone) => setTimeout(gone, 50));
      lost.restoreContext(), await new Promise((back) => setTimeout(back, 200));
      console.log = log;
    }
  }
  culler.dispose(), renderer.dispose(), renderer.forceContextLoss();
  return result;
};

/** What a mirror shows, which draws the scene from elsewhere while it is drawn: views that differ. `still`: the scene itself is
 * looked at from above all of it, and left to three. */
window.mirror = async (views, kind, still) => {
  await ready;
  const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
  renderer.setSize(width, height);
  const scene = new THREE.Scene(), { all, side } = places(900), next = random(4), differs = [];
  add(scene, kind, all, new THREE.MeshBasicMaterial());
  const camera = new THREE.PerspectiveCamera(70, width / height, 0.1, 500), other = camera.clone();
  const mirror = new THREE.Mesh(new THREE.PlaneGeometry(0.1, 0.1), new THREE.MeshBasicMaterial());
  const target = new THREE.WebGLRenderTarget(width, height), seen = new Uint8Array(4 * width * height);
  mirror.onBeforeRender = () => {
    const own = renderer.getRenderTarget();
    mirror.visible = false, renderer.setRenderTarget(target), renderer.render(scene, other);
    mirror.visible = true, renderer.setRenderTarget(own);
    renderer.readRenderTargetPixels(target, 0, 0, width, height, seen);
  };
  camera.add(mirror), mirror.position.set(0, 0, -1), scene.add(camera);
  const culler = new SightlineCuller(scene, { occlusion: false });
  await new Promise((loaded) => setTimeout(loaded, 50));
  for (let v = 0; v < views; ++v) {
    look(camera, next, side), look(other, next, side), other.updateMatrixWorld();
    if (still) camera.position.set(side / 2, 400, side / 2), camera.lookAt(side / 2, 0, side / 2 + 1);
    if (v % 4 === 3) other.position.set(side / 2, 400, side / 2), other.lookAt(side / 2, 0, side / 2 + 1); // all is in view
    const pictures = [false, true].map((on) => ((culler.enabled = on), [pixels(renderer, scene, camera), seen.slice()]));
    if ([0, 1].some((k) => differing(pictures[0][k], pictures[1][k]) > 0)) differs.push(v);
  }
  culler.dispose(), target.dispose(), renderer.dispose(), renderer.forceContextLoss();
  return { differs, own: Object.hasOwn(scene.children[0], 'onBeforeRender') };
};

/** Things that come, go, hide and change, one step after another; the names of the steps whose pictures differ. */
window.changes = async () => {
  await ready;
  const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
  renderer.setSize(width, height);
  const { scene, side } = makeScene(false);
  const camera = new THREE.PerspectiveCamera(70, width / height, 0.1, 500);
  const culler = new SightlineCuller(scene);
  await new Promise((loaded) => setTimeout(loaded, 50));
  const group = scene.children[2], instanced = scene.children[0], batch = scene.children[1];
  const extra = new THREE.Mesh(new THREE.SphereGeometry(2), new THREE.MeshBasicMaterial({ color: 0xffff00 }));
  const child = new THREE.Mesh(new THREE.SphereGeometry(1), new THREE.MeshBasicMaterial({ color: 0x00ffff }));
  child.position.y = 4;
  const steps = {
    nothing() {},
    added() { group.add(extra), extra.position.set(12, 2, 30); },
    'moved by its group'() { group.position.x = 1.5; },
    'a child of a mesh'() { extra.add(child); },
    'on another layer'() { extra.layers.set(3); },
    'seen by that layer'() { camera.layers.enable(3); },
    'a hidden group'() { group.visible = false; },
    'shown again'() { group.visible = true; },
    removed() { group.remove(extra); },
    'fewer instances'() { instanced.count = 300; },
    'a hidden instance'() { batch.setVisibleAt(3, false); },
    'a deleted instance'() { batch.deleteInstance(5); },
    'another geometry'() { batch.setGeometryIdAt(7, 1); },
    'a deformed geometry'() { stretch(group.children[0].geometry, 5); },
    'another index, without the faces before and behind'() {
      const { geometry } = group.children[0];
      geometry.setIndex([...geometry.index.array.slice(0, 24)]);
    },
    'a replaced geometry of the batch'() { batch.setGeometryAt(0, new THREE.BoxGeometry(1.1, 5, 1.1)); },
    'a batch whose matrices somebody writes by themselves'() {
      raise(batch._matricesTexture.image.data, 16, 30), (batch._matricesTexture.needsUpdate = true);
    },
    'instances written by hand'() { raise(instanced.instanceMatrix.array, 10, 60), (instanced.instanceMatrix.needsUpdate = true); },
    'ranges of instances'() {
      for (const i of [0, 80]) { // three is not shown the first of them
        raise(instanced.instanceMatrix.array, i, i + 80);
        instanced.instanceMatrix.clearUpdateRanges(), instanced.instanceMatrix.addUpdateRange(16 * i, 16 * 80);
        instanced.instanceMatrix.needsUpdate = true;
        pixels(renderer, scene, camera);
      }
    },
    'other matrices of as many instances'() {
      instanced.instanceMatrix = instanced.instanceMatrix.clone(), raise(instanced.instanceMatrix.array, 70, 90);
      instanced.instanceMatrix.version = 0;
    },
    'never culled'() { group.children[5].frustumCulled = false; },
    'a see-through house'() { group.children[0].material.transparent = true, (group.children[0].material.opacity = 0.3); },
    'depth written through walls'() { scene.getObjectByName('marker').material.depthWrite = true; },
    'a group with an order'() { group.renderOrder = 2; },
    'seen from the side'() { camera.projectionMatrix.elements[8] = 0.3; },
    'matrix that is not finite'() { group.renderOrder = 0, (group.children[9].scale.x = NaN); },
  };
  const next = random(11), bad = [];
  for (const [name, step] of Object.entries(steps)) {
    step();
    for (let v = 0; v < 4; ++v) {
      look(camera, next, side);
      if (v === 0) camera.position.set(12, 2, 45), camera.rotation.set(0, 0, 0);
      culler.enabled = false;
      const before = pixels(renderer, scene, camera);
      culler.enabled = true;
      const after = pixels(renderer, scene, camera);
      if (differing(before, after) > 0 && judge(renderer, scene, camera, culler, [before, after]).lost > 0) bad.push(name);
    }
    const ray = new THREE.Raycaster(new THREE.Vector3(12, 2, 45), new THREE.Vector3(0, 0, -1));
    if (ray.intersectObjects(scene.children).length === 0) bad.push(`${name}: no ray meets anything`);
  }
  const own = ['onBeforeRender', 'onAfterRender'].filter((key) => Object.hasOwn(scene, key)).length;
  culler.dispose();
  const left = ['onBeforeRender', 'onAfterRender'].filter((key) => Object.hasOwn(scene, key)).length;
  renderer.dispose(), renderer.forceContextLoss();
  return { bad, own, left };
};
