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
    const tab = document.getElementById(`tab-${own}`), isShown = each === part;
    each.element.hidden = !isShown;
    tab.setAttribute('aria-selected', isShown), (tab.tabIndex = isShown ? 0 : -1);
  }
  if (started.has(part)) return;
  started.add(part);
  try {
    await part.start();
    part.started = true;
  } catch (error) {
    stop(part, error.message);
  }
}

/** Why nothing more is drawn there. */
function stop(part, words) {
  part.started = false;
  if (part.busy) part.busy.hidden = true;
  part.said.textContent = words, (part.said.hidden = false);
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

// Arrows, Home and End go from tab to tab, as they do elsewhere.
function turn(event) {
  const tabs = [...event.currentTarget.children], at = tabs.indexOf(event.target), last = tabs.length - 1;
  const to = { ArrowRight: at === last ? 0 : at + 1, ArrowLeft: at === 0 ? last : at - 1, Home: 0, End: last }[event.key];
  if (at < 0 || to === undefined) return;
  event.preventDefault(), tabs[to].focus(), tabs[to].click();
}

// Drivers take WebGL from a page, after a fault for example. The event does not bubble.
for (const [, , part] of parts)
  part.element.addEventListener('webglcontextlost', () => stop(part, 'The browser took WebGL from this page. Load it again to go on.'), true);

const nav = document.querySelector('nav');
nav.addEventListener('keydown', turn);
for (const [name, words, { element: panel }] of parts) {
  nav.append(element('a', { href: `#/${name}`, role: 'tab', id: `tab-${name}`, 'aria-controls': panel.id }, words));
  panel.setAttribute('role', 'tabpanel'), panel.setAttribute('aria-labelledby', `tab-${name}`);
}
document.querySelector('.bar').append(themeButton());
document.querySelector('main').append(...parts.map(([, , part]) => part.element));
const go = () => show(location.hash.slice(2) || 'models');
addEventListener('hashchange', go);
void go();
frames();
window.sightline = Object.fromEntries(parts.map(([name, , part]) => [name, part])); // for the console, and the test
