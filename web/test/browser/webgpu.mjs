// In the page: the same under WebGPURenderer.
import * as THREE from 'three';
import { WebGPURenderer } from 'three/webgpu';
import { ready, SightlineCuller } from 'sightline-culling/three';
import { add, look, places, random } from '../../scenes/city.mjs';

const width = 128, height = 72;

window.compare = async (count) => {
  await ready;
  const renderer = new WebGPURenderer();
  renderer.setSize(width, height);
  await renderer.init();
  const scene = new THREE.Scene(), { all, side } = places(600), material = new THREE.MeshBasicMaterial();
  ['instanced', 'batched', 'meshes'].forEach((kind, k) => add(scene, kind, all.filter((_, i) => i % 3 === k), material, 5000 * k));
  const camera = new THREE.PerspectiveCamera(70, width / height, 0.1, 500), next = random(7);
  const target = new THREE.RenderTarget(width, height), culler = new SightlineCuller(scene);
  const draw = async () => {
    renderer.setRenderTarget(target);
    renderer.render(scene, camera);
    return renderer.readRenderTargetPixelsAsync(target, 0, 0, width, height);
  };
  culler.enabled = false;
  await draw();
  const result = { backend: renderer.backend.isWebGPUBackend ? 'webgpu' : 'webgl', differing: 0, hidden: 0, objects: 0, shown: 0 };
  for (let v = 0; v < count; ++v) {
    look(camera, next, side);
    culler.enabled = false;
    const before = await draw();
    culler.enabled = true;
    const after = await draw();
    for (let i = 0; i < before.length; ++i) if (before[i] !== after[i]) ++result.differing;
    result.shown += before.some((x, i) => i % 4 < 3 && x > 0) ? 1 : 0;
    result.hidden += culler.stats.hidden, (result.objects += culler.stats.objects);
  }
  return result;
};
