// What the charts say, in the pages of the workbench.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import vm from 'node:vm';

const source = (path) => readFileSync(new URL(`../../workbench/${path}`, import.meta.url), 'utf8');
const shared = source('report/charts.js');

// The charts that a page's script asks for.
function chartsOf(script, elements) {
  const charts = [];
  class Chart {
    static defaults = { font: {} };
    constructor(canvas, config) {
      charts.push({ canvas, ...config });
    }
    destroy() {}
  }
  vm.runInNewContext(`${shared}\nlegend = (chart) => chart;\n${source(script)}`, {
    Chart,
    document: { getElementById: () => elements[0], querySelector: () => ({}), documentElement: {}, body: {},
      querySelectorAll: (what) => what.startsWith('canvas') ? elements : [] },
    getComputedStyle: () => ({ getPropertyValue: () => '' }),
    matchMedia: () => ({ matches: false, addEventListener() {} }),
    addEventListener() {},
  });
  return charts;
}

const reportOf = (methods) => chartsOf('report/page.js', [{ parentElement: { style: {} }, textContent: JSON.stringify({ methods,
  views: [0, 1], cull_ms: methods.map(() => [1, 600]), frame_ms: methods.map(() => [1, 600]), kept: methods.map(() => [1, 600]),
  truly_visible: [1, 2], triangles: methods.map(() => 1), draw_calls: methods.map(() => 1) }) }]);
const logarithmic = (charts) => charts.map((chart) => chart.options.scales.y).filter((axis) => axis.type === 'logarithmic');
const report = logarithmic(reportOf(['none']));
const reproduction = logarithmic(chartsOf('reproduce/reproduction.js', [true, false].map((logarithmic) => (
  { dataset: { chart: JSON.stringify({ logarithmic, x: '', y: '', labels: ['a'], series: [{ name: 'ours', values: [1] }] }) } }))));

function left(axis, ticks) {
  const its = { ticks: ticks.map((value) => ({ value })) };
  axis.afterBuildTicks(its);
  return its.ticks.map((tick) => tick.value);
}

test('a line of a logarithmic axis is a power of ten, with its label', () => {
  assert.equal(report.length, 3);
  assert.equal(reproduction.length, 1);
  const decades = [0.01, 0.1, 1, 10, 100], ticks = decades.flatMap((decade) => [1, 2, 3, 4, 5, 6, 7, 8, 9].map((k) => k * decade));
  for (const axis of [...report, ...reproduction]) {
    assert.deepEqual(left(axis, ticks), decades);
    assert.deepEqual(decades.map((value) => Number(axis.ticks.callback(value).replace(',', '.'))), decades);
  }
});

test('a short logarithmic axis has lines, too', () => {
  assert.deepEqual(left(report[0], [2, 3, 4, 5, 6, 7, 8, 9, 10, 15]), [2, 5, 10]);
  assert.deepEqual(left(report[0], [6, 7, 8, 9]), [6, 7, 8, 9]);
});

test('bars of many methods lie, each with room for its name', () => {
  for (const count of [2, 34]) {
    const bars = reportOf(Array.from({ length: count }, (_, i) => `method-${i}`)).filter((chart) => chart.type === 'bar');
    assert.equal(bars.length, 2);
    for (const { canvas, options } of bars) {
      const names = options.scales[options.indexAxis];
      assert.equal(names.ticks.autoSkip, false);
      assert.equal(options.indexAxis, count > 8 ? 'y' : 'x');
      if (count > 8) assert.ok(parseFloat(canvas.parentElement.style.height) / count > 1.4 * names.ticks.font.size);
    }
  }
});
