// What every page that has charts shares: their legend and their logarithmic axis.

// Of its lines the powers of ten; where fewer than two of these are in sight, also twice and five times those, or all:
// each has its label, without which a line says nothing.
const logarithmicAxis = {
  type: "logarithmic",
  afterBuildTicks(axis) {
    const first = tick => Math.round(10 * tick.value / 10 ** Math.floor(Math.log10(tick.value) + 1e-9)) / 10;
    const few = [[1], [1, 2, 5]].map(leading => axis.ticks.filter(tick => leading.includes(first(tick))));
    axis.ticks = few.find(ticks => ticks.length > 1) ?? axis.ticks;
  },
  ticks: { callback: value => new Intl.NumberFormat(undefined, { maximumSignificantDigits: 3 }).format(value) },
};

// A piece of a line, as the chart draws it.
function stroke(set) {
  const picture = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  const of = { viewBox: "0 0 32 2", stroke: set.borderColor, "stroke-width": 2, "stroke-dasharray": (set.borderDash ?? []).join(" ") };
  const path = document.createElementNS(picture.namespaceURI, "path");
  path.setAttribute("d", "M0 1h32");
  for (const [name, value] of Object.entries(of)) picture.setAttribute(name, value);
  picture.append(path);
  return picture;
}

// Below the chart, as many lines as it takes: in the canvas a legend of thirty methods is cut off. A name hides its line or
// shows it, and of many lines two words do so with all of them.
function legend(chart) {
  const list = document.createElement("ul"), figure = chart.canvas.closest("figure"), sets = chart.data.datasets;
  list.className = "legend";
  const add = (onclick, ...words) => {
    const item = document.createElement("li"), name = document.createElement("button");
    name.append(...words), (name.onclick = () => (onclick(), chart.update())), item.append(name), list.append(item);
    return name;
  };
  const show = (i, shown) => (names[i].setAttribute("aria-pressed", shown), chart.setDatasetVisibility(i, shown));
  if (sets.length > 6) {
    for (const [word, shown] of [["show all", true], ["hide all", false]]) add(() => sets.forEach((_, i) => show(i, shown)), word).className = "every";
  }
  const names = sets.map((set, i) => add(() => show(i, !chart.isDatasetVisible(i)), stroke(set), set.label));
  names.forEach(name => name.setAttribute("aria-pressed", "true"));
  figure.querySelector(".legend")?.remove();
  figure.append(list);
  return chart;
}
