// The first part: the five models, their rays, what these keep and lose, and how long it takes.
import { button, choice, count, element, fit, Graph, isDark, median, ms, percent, perSecond, readout, slider, toggle, breath } from '../ui/elements.js';
import { Fly } from '../ui/fly.js';
import { Caster, isOnGpu, judge, methods } from './caster.js';
import { Evidence } from './evidence.js';
import { drawTime } from './measure.js';
import { Models, names } from './models.js';
import { ModelRenderer } from './renderer.js';
import { paperViewpoint, placeAround, placeOnPath, viewOf } from './views.js';

const looks = {
  dark: { haze: [0.1, 0.115, 0.135], kept: [0.96, 0.65, 0.32], culled: [0.3, 0.33, 0.38] },
  light: { haze: [0.93, 0.915, 0.88], kept: [0.87, 0.46, 0.14], culled: [0.72, 0.71, 0.69] } };
const shares = [['1000', 'a thousandth'], ['100', 'a hundredth'], ['10', 'a tenth'], ['1', 'all']];

export class ModelsPart {
  constructor({ strata, quick }) {
    this.quick = quick;
    this.state = { model: 1, share: quick ? 2000 : 100, method: 'saa', rays: 100, byState: false, frozen: false, path: false };
    this.place = paperViewpoint();
    this.strata = strata;
    this.flown = 0, (this.rest = 0), (this.frames = []);
    this.#build();
  }

  /** Loads what it needs; once. */
  async start() {
    this.renderer = new ModelRenderer(this.canvas);
    [this.models, this.caster] = [await Models.start(this.strata()), await Caster.start()];
    this.caster.onlost = (why) => this.#say(why);
    if (!this.caster.gpu) {
      this.#say(this.caster.why);
      this.state.method = 'wide-rays', this.methodChoice.set('wide-rays');
      for (const [name] of methods) if (isOnGpu(name)) this.methodChoice.forbid(name, 'needs WebGPU');
    }
    await this.#load();
  }

  get look() {
    return isDark() ? looks.dark : looks.light;
  }

  #build() {
    const { state } = this, again = () => (this.rest = 0);
    this.canvas = element('canvas', { class: 'stage', ariaLabel: 'The model. Drag to look, W A S D to fly.' });
    new ResizeObserver(again).observe(this.canvas);
    this.fly = new Fly(this.canvas, this.place, { speed: 9000, touched: () => (again(), this.#follow(false)) });
    this.readouts = { frames: readout('frames a second'), kept: readout('meshes drawn'), lost: readout('lost beside the item buffer'), gain: readout('without culling') };
    this.busy = element('div', { class: 'busy', role: 'status' }, 'Making the model…');
    this.said = element('p', { class: 'said', hidden: true });
    this.graph = new Graph('A frame along the path', 'ms', [{ name: 'with culling', colour: '--accent' }, { name: 'without', colour: '--cool' }], { length: 60 });
    this.graph.figure.hidden = true;
    this.methodChoice = choice('Method', [['none', 'none', 'everything is drawn'], ...methods.map(([name, words]) => [name, name, words])], state.method,
      (value) => ((state.method = value), again()));
    this.pathToggle = toggle('follow the recorded path', false, (on) => this.#follow(on));
    this.evidence = new Evidence(this);
    const panel = element('div', { class: 'panel' },
      this.modelChoice = choice('Model', [1, 2, 3, 4, 5].map((n) => [n, String(n), names[n - 1]]), state.model, (value) => ((state.model = value), this.#load())),
      this.modelName = element('p', { class: 'hint' }),
      choice('Triangles of the paper’s', shares.map(([value, words]) => [Number(value), words]), state.share, (value) => ((state.share = value), this.#load())),
      this.methodChoice,
      slider('Rays along each side', { min: 20, max: 400, step: 20, value: state.rays }, (value) => ((state.rays = value), again()), (x) => `${x} × ${x}`),
      element('div', { class: 'row' },
        button('V, the paper’s viewpoint', () => this.#go(paperViewpoint()), { id: 'viewpoint' }),
        button('from above', () => this.#go(placeAround(0, 80)))),
      this.pathToggle,
      toggle('colour what is kept and what is culled', false, (on) => ((state.byState = on), again())),
      this.freezeToggle = toggle('keep this set while I fly on', false, (on) => ((state.frozen = on), again())),
      button('Measure along the path', () => this.measurePath(), { id: 'measure-path' }));
    this.element = element('section', { class: 'part', id: 'models' },
      element('header', {}, element('h2', {}, 'Five geological models'),
        element('p', {}, 'Rays through the viewport meet boxes; the boxes they meet are drawn, and nothing else. Layered, folded and faulted ' +
          'ground with the meshes of Ye et al. 2023, made in your browser.')),
      this.said,
      element('div', { class: 'workspace' },
        element('div', { class: 'view' }, this.canvas, this.busy, element('div', { class: 'readouts' }, Object.values(this.readouts)),
          element('p', { class: 'keys' }, 'drag to look · W A S D Q E to fly · wheel or two fingers to move')),
        panel),
      this.graph.figure, this.evidence.element);
  }

  #say(words) {
    this.said.textContent = /WebGPU|GPU's/.test(words) ? `${words.replace(/; [^;]*$/, '')}. Rays are cast by WebAssembly here, which finds the same set.` : words;
    this.said.hidden = false;
  }
  #follow(on) {
    this.state.path = on, this.pathToggle.set(on);
  }
  #go(place) {
    this.#follow(false);
    Object.assign(this.place, place), (this.rest = 0);
  }

  async #load() {
    const { models, renderer, state } = this, token = (this.token = {});
    if (!models || this.loading) return; // what loads takes the latest wish afterwards
    this.loading = true, (this.busy.hidden = false), (this.ready = false), (this.failed = undefined);
    await this.idle();
    try {
      const wished = { ...state }, triangles = models.paperTriangles(wished.model) / wished.share;
      const plan = models.plan(wished.model, triangles);
      const bytes = plan.vertexCount * 20 + plan.indexCount * 4;
      if (bytes > 1.8e9) throw new Error(`${count(plan.triangles)} triangles would take ${(bytes / 1e9).toFixed(1)} GB of the GPU's memory; choose fewer.`);
      const boxes = await renderer.load(models, plan, (done) => (this.busy.textContent = `Making the model… ${percent(100 * done)}`));
      this.caster.take(boxes);
      this.modelName.textContent = `${names[wished.model - 1]}: ${count(plan.count)} meshes, ${count(plan.triangles)} triangles`;
      this.visible = renderer.all, (this.rest = 0);
      if (token === this.token) (this.ready = true), (this.busy.hidden = true);
    } catch (error) {
      this.busy.textContent = this.failed = error.message;
    }
    this.loading = false;
    if (token !== this.token) await this.#load();
  }
  /** When no rays are on their way. */
  async idle() {
    await this.resting, await this.casting;
  }
  /** Loads a model, and comes back when it stands. */
  async use(model, share = this.state.share) {
    Object.assign(this.state, { model, share });
    await this.#load();
    while (!this.ready && !this.failed) await new Promise((resolve) => setTimeout(resolve, 20));
    if (this.failed) throw new Error(this.failed);
    this.modelChoice.set(model);
  }

  /** A frame; `seconds` since the last. */
  frame(seconds) {
    if (!this.ready || this.measuring) return;
    const { state, place, renderer } = this;
    if (this.fly.step(seconds)) this.rest = 0, this.#follow(false);
    if (state.path) Object.assign(place, placeOnPath((this.flown += seconds / 60))), (this.rest = 0);
    if (fit(this.canvas)) this.rest = 0;
    const view = viewOf(place, this.canvas.width, this.canvas.height);
    if (this.rest === 0) this.told = false;
    const isDue = this.rest > 0.5 && !this.told && !state.path && !state.frozen;
    if (!isDue && !this.told) this.#cull(view);
    else if (isDue && !this.casting) this.#settle(view);
    const objects = state.byState && !state.frozen ? renderer.all : this.visible;
    if (state.byState) renderer.tell(this.visible);
    const triangles = renderer.draw(view, objects, { look: this.look, byState: state.byState && !state.frozen });
    this.frames.push(seconds);
    if (this.frames.length >= this.readouts.frames.tellsAfter) this.#tell(triangles);
    this.rest += seconds;
  }

  // The set of this view, or of the last one where the GPU is still at it.
  #cull(view) {
    const { state, renderer, caster } = this;
    if (state.method === 'none') return void (this.visible = renderer.all);
    if (state.frozen || this.casting || this.resting) return;
    this.casting = caster.cast(state.method, view, state.rays).then(({ visible }) => (this.visible = visible), (error) => this.#say(error.message))
      .finally(() => (this.casting = undefined));
  }

  #tell(triangles) {
    const seconds = median(this.frames.splice(0)), { plan } = this.renderer;
    this.readouts.frames.set(seconds > 0 ? String(Math.round(1 / seconds)) : '–', 'as shown');
    this.readouts.kept.set(count(this.visible.length), `of ${count(plan.count)} · ${percent((100 * triangles) / plan.triangles)} of the triangles`);
  }

  /** One view's frame with and without culling, and what the set loses; waits for the GPU. */
  async measureView(view) {
    const { renderer, caster, state, look } = this, target = renderer.target(view.width, view.height);
    const method = state.method === 'none' ? 'saa' : state.method, casts = [], some = [], all = [];
    let visible;
    for (let round = 0; round < 3; ++round) {
      const cast = await caster.cast(method, view, state.rays);
      visible = cast.visible, casts.push(cast.whole);
      some.push(drawTime(renderer, view, visible, look, target)), all.push(drawTime(renderer, view, renderer.all, look, target));
    }
    const loss = judge(renderer.itemBuffer(view, view.width, view.height), visible, renderer.plan.count);
    return { with_ms: median(casts) + median(some), cast_ms: median(casts), without_ms: median(all), ...loss };
  }

  // Once after the camera came to rest; until it moves the set stays.
  #settle(view) {
    this.told = true;
    this.resting = this.#atRest(view).catch((error) => this.#say(error.message)).finally(() => (this.resting = undefined));
  }
  async #atRest(view) {
    const m = await this.measureView({ ...view });
    this.rested = m;
    const share = m.objectPixels > 0 ? (100 * m.lostPixels) / m.objectPixels : 0;
    this.readouts.lost.set(percent(share), `${count(m.lostObjects)} of ${count(m.visible)} visible`);
    this.readouts.gain.set(perSecond(m.without_ms), `with: ${perSecond(m.with_ms)}, ${ms(m.cast_ms)} ms of it rays`);
  }

  /** Every sixtieth of the path, with and without. */
  async measurePath(steps = this.quick ? 6 : 60) {
    if (!this.ready || this.measuring) return undefined;
    this.measuring = true;
    await this.idle();
    this.graph.length = steps, this.graph.clear(), (this.graph.figure.hidden = false);
    const rows = [];
    for (let k = 0; k < steps; ++k) {
      const place = placeOnPath(k / steps);
      const row = await this.measureView(viewOf(place, 1280, 720));
      rows.push({ eye: place.eye.map(Math.round), ...row });
      this.graph.add(row.with_ms, row.without_ms), this.graph.draw();
      this.renderer.draw(viewOf(place, this.canvas.width, this.canvas.height), this.visible = this.renderer.all, { look: this.look });
      await breath();
    }
    this.measuring = false, (this.rest = 0);
    this.evidence.keep('path', { model: this.state.model, method: this.state.method, rows });
    return rows;
  }
}
