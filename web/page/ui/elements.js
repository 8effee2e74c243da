// What the parts are made of: elements, controls, graphs.

/** An element: properties (`on…` listen, `class`, others are set or are attributes), and children. */
export function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.startsWith('on')) made.addEventListener(name.slice(2), value);
    else if (name === 'class') made.className = value;
    else if (name in made) made[name] = value;
    else made.setAttribute(name, value);
  }
  made.append(...children.flat().filter((child) => child !== undefined && child !== null));
  return made;
}

let names = 0;

/** Buttons of which one is pressed. `choices` are [value, words] each. */
export function choice(label, choices, value, changed) {
  const id = `choice${++names}`;
  const inputs = choices.map(([own, words, title]) => {
    const input = element('input', { type: 'radio', name: id, value: String(own), checked: own === value, id: `${id}-${own}`,
      onchange: () => changed(own) });
    return [input, element('label', { htmlFor: `${id}-${own}`, title: title ?? '' }, words)];
  });
  const made = element('fieldset', { class: 'choice' }, element('legend', {}, label), element('div', {}, inputs.flat()));
  made.set = (next) => inputs.forEach(([input], i) => (input.checked = choices[i][0] === next));
  made.forbid = (own, why) => inputs.forEach(([input, words], i) => {
    if (choices[i][0] === own) (input.disabled = true), (words.title = why);
  });
  return made;
}

export function slider(label, { min, max, step = 1, value }, changed, show = String) {
  const output = element('output', {}, show(value));
  // The label's first control would be the output.
  const input = element('input', { type: 'range', 'aria-label': label, min, max, step, value, oninput: () => {
    output.textContent = show(Number(input.value)), changed(Number(input.value));
  } });
  return element('label', { class: 'slider' }, element('span', {}, label, output), input);
}

export function toggle(label, checked, changed) {
  const input = element('input', { type: 'checkbox', role: 'switch', checked, onchange: () => changed(input.checked) });
  const made = element('label', { class: 'toggle' }, input, element('i', {}), label);
  made.set = (next) => (input.checked = next);
  return made;
}

export const button = (words, pressed, properties = {}) => element('button', { type: 'button', onclick: pressed, ...properties }, words);

/** A figure with its name: `set(text, note)`. `tellsAfter`: of so many frames it is to be told, of few at first. */
export function readout(label) {
  const value = element('b', {}, '–'), note = element('small', {});
  const made = element('div', { class: 'readout' }, element('span', {}, label), value, note);
  made.tellsAfter = 3;
  made.set = (text, words = '') => (value.textContent = text, (note.textContent = words), (made.tellsAfter = 15));
  return made;
}

const separators = /\B(?=(\d{3})+(?!\d))/g;
export const count = (x) => String(Math.round(x)).replace(separators, ',');
export const ms = (x) => (x === undefined || Number.isNaN(x) ? '–' : x >= 100 ? count(x) : x >= 10 ? x.toFixed(1) : x.toFixed(2));
/** Frames a second of so many milliseconds each; no number where a browser's coarse clock saw none go by. */
export const perSecond = (each) => (each > 0 ? `${Math.max(1, Math.round(1000 / each))} / s` : '–');
export const percent = (x) => `${x >= 10 ? x.toFixed(0) : x.toFixed(x >= 1 ? 1 : 2)} %`;
export const median = (all) => all.toSorted((a, b) => a - b)[Math.floor(all.length / 2)];

/** Lines over time, in colours of the page: `series` are { name, colour } with the name of a CSS variable. */
export class Graph {
  constructor(title, unit, series, { length = 240 } = {}) {
    this.series = series.map((one) => ({ ...one, values: [] })), (this.unit = unit), (this.length = length);
    this.canvas = element('canvas', { role: 'img', ariaLabel: title });
    const legend = series.map(({ name, colour }) => element('li', {}, element('i', { style: `background: var(${colour})` }), name));
    this.figure = element('figure', { class: 'graph' }, element('figcaption', {}, title, element('ul', {}, legend)), this.canvas);
  }
  add(...values) {
    this.series.forEach((one, i) => {
      one.values.push(values[i]);
      if (one.values.length > this.length) one.values.shift();
    });
  }
  clear() {
    for (const one of this.series) one.values.length = 0;
  }
  draw() {
    const { canvas } = this, scale = Math.min(devicePixelRatio, 2), width = canvas.clientWidth, height = canvas.clientHeight;
    if (width === 0) return;
    if (canvas.width !== Math.round(width * scale)) (canvas.width = Math.round(width * scale)), (canvas.height = Math.round(height * scale));
    const context = canvas.getContext('2d'), style = getComputedStyle(canvas);
    context.setTransform(scale, 0, 0, scale, 0, 0), context.clearRect(0, 0, width, height);
    const all = this.series.flatMap(({ values }) => values).filter((x) => x !== undefined);
    const top = niceTop(Math.max(...all, 1e-3));
    context.font = `11px ${style.fontFamily}`, (context.textAlign = 'right');
    for (const share of [0, 0.5, 1]) {
      const y = height - 4 - share * (height - 18);
      context.strokeStyle = style.getPropertyValue('--rule'), (context.lineWidth = 1);
      context.beginPath(), context.moveTo(0, y), context.lineTo(width, y), context.stroke();
      context.fillStyle = style.getPropertyValue('--quiet');
      if (share > 0) context.fillText(`${ticks(top * share)} ${this.unit}`, width - 2, y - 3);
    }
    for (const { values, colour } of this.series) this.#line(context, values, style.getPropertyValue(colour), top, width, height);
  }
  #line(context, values, colour, top, width, height) {
    context.strokeStyle = colour, (context.lineWidth = 1.75), (context.lineJoin = 'round');
    context.beginPath();
    let open = false;
    values.forEach((value, i) => {
      if (value === undefined) return void (open = false);
      const x = (i / (this.length - 1)) * width, y = height - 4 - Math.min(1, value / top) * (height - 18);
      if (open) context.lineTo(x, y);
      else context.moveTo(x, y);
      open = true;
    });
    context.stroke();
  }
}
const ticks = (x) => (x >= 1000 ? count(x) : String(Number(x.toPrecision(2))));
function niceTop(most) {
  const power = 10 ** Math.floor(Math.log10(most));
  return [1, 1.5, 2, 3, 5, 7.5, 10].map((x) => x * power).find((x) => x >= most);
}

/** Lets the browser draw and listen. */
export const breath = () => new Promise((resolve) => setTimeout(resolve));

/** Hands the user a file. */
export function download(name, text) {
  const link = element('a', { href: URL.createObjectURL(new Blob([text], { type: 'application/json' })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** Whether this browser shows dark pages, or the user chose to. */
export const isDark = () => {
  const chosen = document.documentElement.dataset.theme;
  return chosen ? chosen === 'dark' : matchMedia('(prefers-color-scheme: dark)').matches;
};

/** Fits a canvas to its box; whether its size changed. */
export function fit(canvas) {
  const scale = Math.min(devicePixelRatio, 2), width = Math.max(1, Math.round(canvas.clientWidth * scale));
  const height = Math.max(1, Math.round(canvas.clientHeight * scale));
  if (canvas.width === width && canvas.height === height) return false;
  canvas.width = width, (canvas.height = height);
  return true;
}
