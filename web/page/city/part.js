// The second part: a city of moving and still things in three.js, drawn without culling, with three's own, and with Sightline.
import * as THREE from 'three';
import { ready } from 'sightline-culling/three';
import { breath, button, choice, count, element, Graph, median, ms, percent, readout, slider, toggle } from '../ui/elements.js';
import { City, walk } from './scene.js';
import { Stage } from './stage.js';

const modes = [['none', 'none', 'everything is sent to the GPU'], ['three', 'three’s own', 'three.js tests each object’s sphere'],
  ['frustum', 'Sightline', 'what is outside the view'], ['occlusion', 'Sightline with occlusion', 'what is hidden behind houses, too']];

export class CityPart {
  constructor({ quick }) {
    this.quick = quick;
    this.state = { objects: quick ? 1000 : 100_000, kind: 'batched', mode: 'occlusion', moving: 1, walk: true, depth: false, frozen: false };
    this.time = 8, (this.samples = []);
    this.#build();
  }
  async start() {
    this.stage.start();
    await ready.catch((error) => ((this.said.textContent = `${error.message} The city is drawn as three.js draws it.`), (this.said.hidden = false)));
    await this.#make();
  }

  #build() {
    const { state } = this;
    this.stage = new Stage('The city. Drag to look, W A S D to walk.', { speed: 14, far: 1500 });
    this.stage.flown = () => this.#walk(false);
    this.readouts = { frames: readout('frames a second'), thread: readout('render() on the main thread'), drawn: readout('drawn'), hidden: readout('hidden behind houses') };
    this.graphs = [new Graph('render() on the main thread', 'ms', [{ name: 'this frame', colour: '--accent' }]),
      new Graph('Objects drawn', '', [{ name: 'drawn', colour: '--cool' }, { name: 'hidden', colour: '--third' }])];
    this.busy = element('div', { class: 'busy', role: 'status' }, 'Building the city…');
    this.said = element('p', { class: 'said', hidden: true });
    this.walkToggle = toggle('walk along the streets', true, (on) => this.#walk(on));
    this.freezeToggle = toggle('freeze the culler’s camera, and fly on', false, (on) => this.#freeze(on));
    this.result = element('div', { class: 'wide' });
    const remake = (name) => (value) => ((state[name] = value), this.#make());
    this.modeChoice = choice('Culling', modes, state.mode, (value) => ((state.mode = value), this.#mode()));
    const panel = element('div', { class: 'panel' },
      this.modeChoice,
      choice('Objects', [1000, 10_000, 100_000].map((n) => [n, count(n)]), state.objects, remake('objects')),
      choice('Drawn as', [['instanced', 'one InstancedMesh'], ['batched', 'one BatchedMesh'], ['meshes', 'meshes of their own']], state.kind, remake('kind')),
      slider('Of those that can, turning each frame', { min: 0, max: 20, value: state.moving }, (value) => (state.moving = value), (x) => `${x} %`),
      this.walkToggle, this.freezeToggle,
      toggle('show the depth that hides things', false, (on) => ((state.depth = on), (this.stage.depth.hidden = !on))),
      button('Compare all four from here', () => this.compare(), { id: 'compare', class: 'main' }));
    this.element = element('section', { class: 'part', id: 'city', hidden: true },
      element('header', {}, element('h2', {}, 'A city in three.js'),
        element('p', {}, 'A hundred thousand things, some of which turn. One line adds the culler, and what you see stays the same to the pixel: ',
          element('code', {}, 'new SightlineCuller(scene)'))),
      this.said,
      element('div', { class: 'workspace' },
        element('div', { class: 'view' }, this.stage.canvas, this.stage.depth, this.busy,
          element('div', { class: 'readouts' }, Object.values(this.readouts)),
          element('p', { class: 'keys' }, 'drag to look · W A S D Q E to fly · wheel or two fingers to move')),
        panel),
      element('div', { class: 'graphs' }, this.graphs.map(({ figure }) => figure)), this.result);
  }

  #walk(on) {
    if (this.state.walk && !on) this.stage.takePlace();
    this.state.walk = on, this.walkToggle.set(on);
  }
  #freeze(on) {
    this.state.frozen = on, this.freezeToggle.set(on);
    if (on) this.#walk(false);
    this.stage.freeze(on);
  }

  async #make() {
    const token = (this.token = {});
    this.made = false, (this.busy.hidden = false);
    await breath(), await breath();
    if (token !== this.token) return;
    this.city?.dispose();
    this.city = new City(this.state.objects, this.state.kind);
    this.city.scene.fog = new THREE.Fog('#fff', 150, 1100);
    this.stage.ground = this.city.ground;
    this.stage.show(this.city.scene, 0.1, 1500);
    this.#freeze(false), this.#walk(true), this.#mode();
    for (const graph of this.graphs) graph.clear();
    await breath();
    this.made = true, (this.busy.hidden = true);
  }
  #mode() {
    const { mode } = this.state, { culler } = this.stage;
    this.modeChoice.set(mode);
    culler.enabled = mode === 'frustum' || mode === 'occlusion';
    culler.occlusion = mode === 'occlusion';
    this.city.threeCulls = mode !== 'none';
  }

  frame(seconds) {
    if (!this.made || this.comparing) return;
    const { state, stage, city } = this;
    this.time += Math.min(seconds, 0.1);
    if (state.walk) walk(stage.camera, city.side, this.time);
    else stage.fly.step(seconds), stage.usePlace();
    city.turn(state.moving / 100, this.time);
    const thread = stage.draw(), { stats } = stage.culler, culls = stage.culler.enabled;
    const drawn = culls ? stats.drawn : undefined;
    this.samples.push({ seconds, thread });
    this.graphs[0].add(thread), this.graphs[1].add(drawn ?? state.objects, culls ? stats.hidden : undefined);
    for (const graph of this.graphs) graph.draw();
    if (state.depth) stage.showDepth();
    if (this.samples.length >= this.readouts.frames.tellsAfter) this.#tell(drawn, stats);
  }
  #tell(drawn, stats) {
    const all = this.samples.splice(0), { info } = this.stage.renderer, r = this.readouts;
    r.frames.set(String(Math.round(1 / median(all.map(({ seconds }) => seconds)))), 'as shown');
    r.thread.set(`${ms(median(all.map(({ thread }) => thread)))} ms`, `${count(info.render.calls)} calls`);
    r.drawn.set(count(drawn ?? this.state.objects), `${count(info.render.triangles)} triangles`);
    r.hidden.set(this.state.mode === 'occlusion' ? count(stats.hidden) : '–', this.state.mode === 'occlusion' ? `by ${stats.occluders} occluders` : '');
  }

  /** The four by turns from this place, whole frames; what the pictures differ in. */
  async compare() {
    if (!this.made || this.comparing) return undefined;
    this.comparing = true;
    const before = this.state.mode, rows = Object.fromEntries(modes.map(([mode]) => [mode, { thread: [], whole: [] }]));
    for (let round = 0; round < (this.quick ? 2 : 7); ++round) {
      for (const [mode] of modes) {
        this.state.mode = mode, this.#mode();
        this.city.turn(this.state.moving / 100, this.time += 0.01);
        const { thread, whole } = this.stage.drawWhole();
        if (round > 0) rows[mode].thread.push(thread), rows[mode].whole.push(whole);
        rows[mode].triangles = this.stage.renderer.info.render.triangles;
        await breath();
      }
    }
    this.state.mode = before, this.#mode();
    this.comparing = false;
    const base = median(rows.three.thread);
    this.result.replaceChildren(element('table', {},
      element('caption', {}, `${count(this.state.objects)} things, ${this.state.kind}; medians, by turns`),
      element('thead', {}, element('tr', {}, ['culling', 'render()', 'beside three’s', 'until drawn', 'triangles'].map((words) => element('th', {}, words)))),
      element('tbody', {}, modes.map(([mode, words]) => element('tr', {}, element('th', {}, words), element('td', {}, `${ms(median(rows[mode].thread))} ms`),
        element('td', {}, percent((100 * median(rows[mode].thread)) / base)), element('td', {}, `${ms(median(rows[mode].whole))} ms`),
        element('td', {}, count(rows[mode].triangles)))))));
    return rows;
  }
}
