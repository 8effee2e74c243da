// The paper's table 6 and figures 12 and 13, measured here, beside what is printed and what the native program measures.
import { button, count, download, element, isDark, ms, percent } from '../ui/elements.js';
import { methods } from './caster.js';
import { drawFigure12, measureFigure13, measureTable } from './measure.js';
import { names } from './models.js';

/* global FIGURES */ // build.mjs: of workbench/reproduce/published and benchmarks/results
const figures = FIGURES;

export class Evidence {
  constructor(part) {
    this.part = part;
    this.data = {};
    this.table = element('div', { class: 'wide' });
    this.twelve = element('div', { class: 'pictures' });
    this.thirteen = element('div', { class: 'pictures' });
    this.bar = element('progress', { max: 1, value: 0, hidden: true, ariaLabel: 'measuring' });
    this.buttons = [button('Measure table 6', () => this.run(() => this.measureTable()), { id: 'table-6', class: 'main' }),
      button('Draw figure 12', () => this.run(() => this.draw12()), { id: 'figure-12' }),
      button('Measure figure 13', () => this.run(() => this.measure13()), { id: 'figure-13' }),
      button('Download JSON', () => this.save(), { id: 'download' })];
    this.element = element('div', { class: 'evidence' },
      element('h3', {}, 'The paper’s table and figures, in this browser on this GPU'),
      element('p', {}, 'Milliseconds of one visible set from V by 100 × 100 rays, medians, methods by turns; “first” adds tree, buffers and one drawn ' +
        'frame. Printed beside them, and what the native program measures where the GPU is a CPU (lavapipe). All find the same set.'),
      element('div', { class: 'row' }, this.buttons, this.bar),
      this.table, this.twelve, this.thirteen);
    this.#drawTable();
  }

  keep(name, value) {
    this.data[name] = value;
  }

  /** Everything measured so far. */
  get report() {
    const { caster, renderer } = this.part;
    return { when: new Date().toISOString(), browser: navigator.userAgent, webgpu: caster?.gpu?.name ?? null, webgl: renderer?.name ?? null,
      published: figures.published, native: figures.native, ...this.data };
  }
  save() {
    download('sightline-ray-pvs.json', `${JSON.stringify(this.report, undefined, 1)}\n`);
  }

  // One measurement at a time, the camera's frames waiting.
  async run(measure) {
    const { part } = this;
    if (!part.ready || part.measuring) return;
    for (const each of this.buttons) each.disabled = true;
    this.bar.hidden = false;
    try {
      part.measuring = true;
      await part.idle();
      await measure();
    } catch (error) {
      part.said.textContent = error.message, (part.said.hidden = false);
    }
    part.measuring = false, (this.bar.hidden = true);
    for (const each of this.buttons) each.disabled = false;
  }

  async measureTable() {
    const { part } = this, before = part.state.model, rows = [];
    for (let model = 1; model <= 5; ++model) {
      await part.use(model);
      rows.push(await measureTable(part, { rays: part.quick ? 24 : 100, repeats: part.quick ? 1 : 3,
        progress: (done) => (this.bar.value = (model - 1 + done) / 5) }));
      this.keep('table6', rows), this.#drawTable();
    }
    await part.use(before);
  }

  #drawTable() {
    const rows = this.data.table6 ?? [], named = methods.map(([name]) => name);
    const head = element('tr', {}, element('th', {}, 'model'), element('th', {}, ''), named.map((name) => element('th', {}, name)));
    const body = names.map((name, i) => {
      const here = rows.find(({ model }) => model === i + 1), native = figures.native[i + 1] ?? {}, printed = figures.published[i + 1] ?? {};
      const line = (kind, words, of) => element('tr', { class: kind }, kind === 'here'
        ? element('th', { rowSpan: 4 }, String(i + 1), element('small', {}, name)) : undefined,
      element('td', {}, words), named.map((method) => element('td', {}, of(method))));
      return element('tbody', {}, line('here', 'here', (m) => ms(here?.times[m]?.ready_ms)), line('first', 'here, first', (m) => ms(here?.times[m]?.first_ms)),
        line('native', 'native', (m) => ms(native[m])), line('printed', 'printed', (m) => ms(printed[m])));
    });
    const notes = rows.map((row) => {
      const wrong = Object.values(row.differing).reduce((a, b) => a + b, 0);
      return element('li', {}, `Model ${row.model}, ${count(row.triangles)} triangles: ${count(row.kept)} of ${count(row.meshes)} meshes kept, of ` +
        `${count(row.visible)} that show ${count(row.lostObjects)} lost with ${percent((100 * row.lostPixels) / row.objectPixels)} of the pixels` +
        `${figures.native[row.model]?.lost_share ? ` (native: ${percent(figures.native[row.model].lost_share)})` : ''}; ` +
        `rays whose hits differ between methods: ${count(wrong)}.`);
    });
    this.table.replaceChildren(element('table', {}, element('caption', {}, 'Table 6: ms for a visible set'), element('thead', {}, head), body),
      element('ul', { class: 'notes' }, notes));
  }

  async draw12() {
    const { part } = this;
    const { pictures, kept } = await drawFigure12(part, part.quick ? 24 : 100, part.quick ? 480 : 960);
    this.keep('figure12', { model: part.state.model, kept });
    const words = ['12a: from V, everything drawn', '12b: from above, V beyond the lower edge'];
    this.twelve.replaceChildren(...pictures.map((picture, i) => {
      const canvas = element('canvas', { width: picture.width, height: picture.height, role: 'img', ariaLabel: words[i] });
      canvas.getContext('2d').putImageData(picture, 0, 0);
      return element('figure', {}, canvas, element('figcaption', {}, `Figure ${words[i]}: of model ${part.state.model} ${count(kept)} meshes are kept` +
        `${figures.native[part.state.model]?.kept ? ` (natively ${count(figures.native[part.state.model].kept)}, of more triangles or fewer)` : ''}, in colour; what is grey is culled${i === 0 ? ' though it shows' : ''}.`));
    }));
  }

  async measure13() {
    const { part } = this;
    if (part.state.model !== 4) await part.use(4);
    const points = await measureFigure13(part, { apart: part.quick ? 90 : 30, rise: part.quick ? 40 : 25, rays: part.quick ? 24 : 100,
      progress: (done) => (this.bar.value = done) });
    this.keep('figure13', points);
    this.thirteen.replaceChildren(element('figure', {}, dome(points), element('figcaption', {}, sentence(points))));
  }
}

const sentence = (points) => {
  const ratios = points.map(({ ratio }) => ratio), native = figures.native.figure13;
  return `Figure 13: around model 4, the middle straight above it and V at the right. Everything takes ${Math.min(...ratios).toFixed(2)} (red) to ` +
    `${Math.max(...ratios).toFixed(2)} (green) times as long to draw as the set alone` +
    `${native ? `; natively ${native[0].toFixed(2)} to ${native[1].toFixed(2)}` : ''}. The paper prints colours, no numbers.`;
};

// Viewpoints as seen from above: the farther out, the lower.
function dome(points) {
  const space = 'http://www.w3.org/2000/svg', svg = document.createElementNS(space, 'svg');
  svg.setAttribute('viewBox', '-110 -110 220 220'), svg.setAttribute('role', 'img'), svg.setAttribute('class', 'dome');
  const add = (tag, attributes) => {
    const made = document.createElementNS(space, tag);
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    return svg.appendChild(made);
  };
  for (const above of [0, 25, 50, 75]) add('circle', { r: 100 - above, class: 'ring' });
  const ratios = points.map(({ ratio }) => ratio), least = Math.min(...ratios), most = Math.max(...ratios);
  for (const { aside, above, ratio } of points) {
    const radius = 100 - above, angle = (aside * Math.PI) / 180, share = most > least ? (ratio - least) / (most - least) : 1;
    const dot = add('circle', { cx: radius * Math.cos(angle), cy: radius * Math.sin(angle), r: 5.5, fill: `hsl(${Math.round(130 * share)} 70% ${isDark() ? 52 : 44}%)` });
    dot.appendChild(document.createElementNS(space, 'title')).textContent = `${aside}° aside, ${above}° above: ${ratio.toFixed(2)}`;
  }
  return svg;
}
