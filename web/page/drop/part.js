// The third part: a GLB of the visitor's own, which of it is drawn, and what culling gains.
import * as THREE from 'three';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { ready } from 'sightline-culling/three';
import { matrixOf, places } from '../../scenes/city.mjs';
import { breath, button, choice, count, element, Graph, isDark, median, ms, percent, readout, toggle } from '../ui/elements.js';
import { walk } from '../city/scene.js';
import { Stage } from '../city/stage.js';

const modes = [['none', 'none'], ['three', 'three’s own'], ['frustum', 'Sightline'], ['occlusion', 'with occlusion']];

// What to look at before one has a file: some streets of separate meshes.
function sample() {
  const { all, side } = places(3000, 3), group = new THREE.Group(), box = new THREE.BoxGeometry(), cone = new THREE.ConeGeometry(0.5, 1, 10);
  const paints = ['#c9a27e', '#b8bec6', '#d9c7ae', '#4f9d8f', '#e0703c', '#e8b04a'].map((color) => new THREE.MeshStandardMaterial({ color, roughness: 0.9 }));
  all.forEach((place, i) => {
    const still = place.turn === 0, mesh = new THREE.Mesh(still || i % 2 ? box : cone, paints[still ? i % 3 : 3 + (i % 3)]);
    matrixOf(place).decompose(mesh.position, mesh.quaternion, mesh.scale);
    group.add(mesh);
  });
  const ground = new THREE.Mesh(new THREE.PlaneGeometry(side + 60, side + 60).rotateX(-Math.PI / 2), new THREE.MeshStandardMaterial({ color: '#a39a82', roughness: 1 }));
  ground.position.set(side / 2 - 12, -0.02, side / 2 - 12), group.add(ground);
  group.userData.tour = (camera, time) => walk(camera, side, time + 9);
  return group;
}

// What is wrong with a file, without a full stop; a loader that reads beyond its end names an array's length.
const saidOf = (error) => error instanceof RangeError ? `it is cut short or damaged (${error.message})`
  : error.message.replace(/[.\s]+$/, '');

export class DropPart {
  constructor({ quick }) {
    this.quick = quick;
    this.state = { mode: 'occlusion', orbit: true, overview: true };
    this.time = 0, (this.samples = []);
    this.#build();
  }
  async start() {
    this.stage.start();
    await ready.catch((error) => this.#say(error.message));
    this.#take(sample(), 'sample streets');
  }

  #build() {
    const { state } = this;
    this.stage = new Stage('Your model. Drag to look, W A S D to fly.', { speed: 5, far: 1000 });
    this.stage.flown = () => this.#orbit(false);
    this.said = element('p', { class: 'said', hidden: true, role: 'alert' });
    this.readouts = { frames: readout('frames a second'), drawn: readout('meshes drawn'), triangles: readout('triangles'), thread: readout('render()') };
    this.file = element('input', { type: 'file', accept: '.glb,model/gltf-binary', id: 'file', onchange: () => this.#open(this.file.files[0]) });
    this.drop = element('label', { class: 'drop', htmlFor: 'file' }, element('b', {}, 'Drop a GLB here'), element('span', {}, 'or choose a file; it stays in your browser'), this.file);
    const over = (on) => (event) => (event.preventDefault(), this.drop.classList.toggle('over', on));
    for (const target of [this.drop, this.stage.canvas]) {
      target.addEventListener('dragover', over(true)), target.addEventListener('dragleave', over(false));
      target.addEventListener('drop', (event) => (over(false)(event), this.#open(event.dataTransfer.files[0])));
    }
    this.graph = new Graph('render() on the main thread', 'ms', [{ name: 'this frame', colour: '--accent' }]);
    this.name = element('p', { class: 'hint' });
    this.orbitToggle = toggle('move about slowly', true, (on) => this.#orbit(on));
    this.result = element('div', { class: 'wide' });
    this.modeChoice = choice('Culling', modes, state.mode, (value) => ((state.mode = value), this.#mode()));
    this.freezeToggle = toggle('freeze the culler’s camera, and fly on', false, (on) => (on && this.#orbit(false), this.stage.freeze(on)));
    const panel = element('div', { class: 'panel' }, this.drop, this.name, this.modeChoice, this.orbitToggle, this.freezeToggle,
      toggle('small view from above: drawn in colour, culled in grey', true, (on) => (state.overview = on)),
      button('What does culling gain here?', () => this.compare(), { id: 'gain', class: 'main' }));
    this.element = element('section', { class: 'part', id: 'drop', hidden: true },
      element('header', {}, element('h2', {}, 'Your own model'), element('p', {}, 'Drop a GLB to see which of it is drawn from where you stand, and what culling gains.')),
      this.said,
      element('div', { class: 'workspace' },
        element('div', { class: 'view' }, this.stage.canvas, element('div', { class: 'readouts' }, Object.values(this.readouts)),
          element('p', { class: 'keys' }, 'drag to look · W A S D Q E to fly · wheel or two fingers to move')),
        panel),
      this.graph.figure, this.result);
  }
  #say(words) {
    this.said.textContent = words, (this.said.hidden = !words);
  }
  #orbit(on) {
    if (this.state.orbit && !on) this.stage.takePlace();
    this.state.orbit = on, this.orbitToggle.set(on);
  }

  async #open(file) {
    if (!file) return;
    this.#say('');
    try {
      const bytes = await file.arrayBuffer();
      if (new DataView(bytes).byteLength < 20 || new DataView(bytes).getUint32(0, true) !== 0x46546c67)
        throw new Error('it is no binary glTF, which begins with “glTF”');
      const { scene } = await new GLTFLoader().parseAsync(bytes, '');
      if (!scene) throw new Error('the model has no scene');
      let meshes = 0;
      scene.traverse(({ isMesh }) => (meshes += isMesh ? 1 : 0));
      if (meshes === 0) throw new Error('there is no mesh in it');
      this.#take(scene, file.name);
    } catch (error) {
      this.#say(`${file.name} cannot be shown: ${saidOf(error)}.`);
    }
  }

  #take(root, name) {
    const scene = new THREE.Scene(), sun = new THREE.DirectionalLight('#ffe9c8', 2.4);
    sun.position.set(0.55, 0.75, 0.4);
    scene.add(sun, new THREE.HemisphereLight('#eef3fa', '#b5a184', 2.1), root);
    root.updateMatrixWorld(true);
    this.tour = root.userData.tour instanceof Function ? root.userData.tour : undefined;
    this.box = new THREE.Box3().setFromObject(root);
    this.meshes = [], (this.triangles = 0);
    let drawn = 0;
    root.traverse((each) => {
      if (!each.isMesh) return;
      const { count: times = 1, geometry } = each; // an instanced mesh is drawn so often
      this.meshes.push(each), (drawn += times);
      this.triangles += (times * (geometry.index?.count ?? geometry.attributes.position.count)) / 3;
    });
    const size = this.box.getSize(new THREE.Vector3()).length() || 1;
    this.stage.fly.speed = size / 8;
    this.stage.ground = undefined, this.stage.show(scene, size / 5000, size * 3);
    this.#overviewFor(size);
    this.name.textContent = `${name}: ${count(drawn)} meshes, ${count(this.triangles)} triangles`;
    this.freezeToggle.set(false), this.#orbit(true), this.#mode(), this.graph.clear(), this.result.replaceChildren();
    this.made = true;
  }
  #overviewFor(size) {
    const centre = this.box.getCenter(new THREE.Vector3());
    this.above = new THREE.PerspectiveCamera(35, 1, size / 1000, size * 6);
    // So far off that the sphere about the box is whole in it.
    const away = (0.5 * size) / Math.sin((17.5 * Math.PI) / 180);
    this.above.position.copy(centre).addScaledVector(new THREE.Vector3(0.35, 1.15, 0.7).normalize(), away), this.above.lookAt(centre);
    this.ghost ??= new THREE.MeshBasicMaterial({ color: '#8b939e', transparent: true, opacity: 0.34, depthWrite: false, depthFunc: THREE.LessDepth });
  }
  #mode() {
    const { mode } = this.state, { culler } = this.stage;
    this.modeChoice.set(mode);
    culler.enabled = mode === 'frustum' || mode === 'occlusion', (culler.occlusion = mode === 'occlusion');
    for (const mesh of this.meshes) mesh.frustumCulled = mode !== 'none';
  }

  frame(seconds) {
    if (!this.made || this.comparing) return;
    const { state, stage } = this;
    if (state.orbit) this.#circle((this.time += Math.min(seconds, 0.1)));
    else stage.fly.step(seconds), stage.usePlace();
    const thread = stage.draw(), { render } = stage.renderer.info, told = { triangles: render.triangles, ...stage.culler.stats };
    if (state.overview) this.#overview();
    this.graph.add(thread), this.graph.draw();
    this.samples.push({ seconds, thread });
    if (this.samples.length < this.readouts.frames.tellsAfter) return;
    const all = this.samples.splice(0), r = this.readouts, culls = stage.culler.enabled;
    r.frames.set(String(Math.round(1 / median(all.map((each) => each.seconds)))), 'as shown');
    r.drawn.set(culls ? count(told.drawn) : '–', culls ? `of ${count(told.objects)}, ${count(told.hidden)} hidden` : '');
    r.triangles.set(count(told.triangles), `of ${count(this.triangles)}`);
    r.thread.set(`${ms(median(all.map((each) => each.thread)))} ms`, 'on the main thread');
  }
  #circle(time) {
    const { box, tour, stage: { camera } } = this;
    if (tour) return void tour(camera, time);
    const centre = box.getCenter(new THREE.Vector3()), half = box.getSize(new THREE.Vector3()).multiplyScalar(0.5);
    const a = time / 14, eye = new THREE.Vector3(centre.x + 0.55 * half.x * Math.cos(a), box.min.y + Math.min(half.y, 0.12 * Math.hypot(half.x, half.z)), centre.z + 0.55 * half.z * Math.sin(a));
    camera.position.copy(eye);
    camera.lookAt(eye.x - half.x * Math.sin(a + 0.5), eye.y - 0.02 * half.y, eye.z + half.z * Math.cos(a + 0.5));
  }

  // In a corner: all of it in grey, and in colour what the culler keeps for the camera.
  #overview() {
    const { stage, above, ghost } = this, { renderer, scene, culler, canvas } = stage;
    const width = Math.round(canvas.width * 0.28), height = Math.round(width * 0.75), margin = Math.round(canvas.width * 0.015);
    above.aspect = width / height, above.updateProjectionMatrix();
    const background = scene.background, enabled = culler.enabled;
    renderer.setScissorTest(true);
    for (const set of ['setViewport', 'setScissor']) renderer[set](canvas.width - width - margin, margin, width, height);
    scene.background = new THREE.Color(isDark() ? '#0c1015' : '#f8f6f1');
    culler.camera = stage.frozen ?? stage.camera;
    renderer.render(scene, above);
    // What was not drawn shows before what was, and beside it.
    culler.camera = undefined, (culler.enabled = false), (scene.overrideMaterial = ghost), (scene.background = null), (renderer.autoClear = false);
    renderer.render(scene, above);
    culler.enabled = enabled, (scene.overrideMaterial = null), (renderer.autoClear = true), (scene.background = background);
    renderer.setScissorTest(false), renderer.setViewport(0, 0, canvas.width, canvas.height);
  }

  /** The four by turns, at places on the way. */
  async compare() {
    if (!this.made || this.comparing) return undefined;
    this.comparing = true;
    const before = this.state.mode, rows = Object.fromEntries(modes.map(([mode]) => [mode, { thread: [], whole: [], triangles: [] }]));
    for (let at = 0; at < (this.quick ? 3 : 24); ++at) {
      if (this.state.orbit) this.#circle(this.time + at * 3.7);
      for (const [mode] of modes) {
        this.state.mode = mode, this.#mode();
        const { thread, whole } = this.stage.drawWhole();
        if (at === 0) continue;
        rows[mode].thread.push(thread), rows[mode].whole.push(whole), rows[mode].triangles.push(this.stage.renderer.info.render.triangles);
      }
      await breath();
    }
    this.state.mode = before, this.#mode(), (this.comparing = false);
    this.result.replaceChildren(element('table', {},
      element('caption', {}, this.state.orbit ? 'Medians on the way, by turns' : 'Medians from here, by turns'),
      element('thead', {}, element('tr', {}, ['culling', 'render()', 'until drawn', 'triangles', 'of all'].map((words) => element('th', {}, words)))),
      element('tbody', {}, modes.map(([mode, words]) => element('tr', {}, element('th', {}, words), element('td', {}, `${ms(median(rows[mode].thread))} ms`),
        element('td', {}, `${ms(median(rows[mode].whole))} ms`), element('td', {}, count(median(rows[mode].triangles))),
        element('td', {}, percent((100 * median(rows[mode].triangles)) / this.triangles)))))));
    return rows;
  }
}
