// The page: three parts, of which one shows and runs.
import { CityPart } from './city/part.js';
import { DropPart } from './drop/part.js';
import { ModelsPart } from './models/part.js';
import { button, element } from './ui/elements.js';
import strata from '../../build/web/page/strata.wasm';

const quick = new URLSearchParams(location.search).has('quick'); // small, to be tested where the GPU is a CPU
const parts = [['models', 'Models', new ModelsPart({ strata: () => strata, quick })], ['city', 'City', new CityPart({ quick })], ['drop', 'Your model', new DropPart({ quick })]];
const started = new Set();
let shown;

async function show(name) {
  const [, , part] = parts.find(([own]) => own === name) ?? parts[0];
  if (shown === part) return;
  shown = part;
  for (const [own, , each] of parts) {
    each.element.hidden = each !== part;
    document.getElementById(`tab-${own}`).ariaSelected = String(each === part);
  }
  if (started.has(part)) return;
  started.add(part);
  try {
    await part.start();
    part.started = true;
  } catch (error) {
    part.said.textContent = error.message, (part.said.hidden = false);
  }
}

function frames() {
  let last = performance.now();
  const frame = (now) => {
    if (shown?.started && !document.hidden) shown.frame(Math.max(1e-4, (now - last) / 1000));
    last = now;
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
}

function themeButton() {
  const dark = matchMedia('(prefers-color-scheme: dark)'), root = document.documentElement;
  return button('◐', () => {
    const isDark = root.dataset.theme ? root.dataset.theme === 'dark' : dark.matches;
    root.dataset.theme = isDark ? 'light' : 'dark';
  }, { class: 'theme', title: 'light or dark', ariaLabel: 'light or dark' });
}

document.querySelector('nav').append(...parts.map(([name, words]) => element('a', { href: `#/${name}`, role: 'tab', id: `tab-${name}` }, words)));
document.querySelector('.bar').append(themeButton());
document.querySelector('main').append(...parts.map(([, , part]) => part.element));
const go = () => show(location.hash.slice(2) || 'models');
addEventListener('hashchange', go);
void go();
frames();
window.sightline = Object.fromEntries(parts.map(([name, , part]) => [name, part])); // for the console, and the test
