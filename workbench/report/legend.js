// A chart's legend, for every page that has charts.

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
