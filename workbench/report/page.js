// Draws the charts from the data that stands in the page.
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const style = getComputedStyle(document.documentElement);
  const colour = name => style.getPropertyValue(name).trim();
  const palette = ["#7f8791", "#1f77c8", "#e09a22", "#2a9d6e", "#b04fc0", "#d9553f", "#18a0b0", "#8a6d3b"];
  const of = i => palette[i % palette.length];
  // Five, as eight colours come round: no two of forty lines look alike.
  const dash = i => [[], [7, 4], [2, 3], [16, 3], [9, 3, 2, 3]][i % 5];

  Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
  Chart.defaults.animation = false;
  Chart.defaults.maintainAspectRatio = false;

  function themed() {
    Chart.defaults.color = colour("--quiet");
    Chart.defaults.borderColor = colour("--rule");
  }

  function line(id, y, series) {
    return legend(new Chart(document.getElementById(id), {
      type: "line",
      data: {
        labels: data.views,
        datasets: series.map(s => ({
          label: s.label, data: s.values, borderColor: s.colour, backgroundColor: s.colour, borderDash: s.dash || [],
          borderWidth: s.width || 1.75, pointRadius: data.views.length < 3 ? 3 : 0, pointHitRadius: 8, tension: 0.15,
        })),
      },
      options: {
        interaction: { mode: "index", intersect: false },
        plugins: { legend: { display: false } },
        scales: {
          x: { title: { display: true, text: "view" }, ticks: { maxTicksLimit: 12 }, grid: { display: false } },
          y: { title: { display: true, text: y }, ...logarithmicAxis },
        },
      },
    }));
  }

  // Many lie, one below the other: beside one another their names would run into each other.
  function bars(id, what, values) {
    const canvas = document.getElementById(id), lie = data.methods.length > 8;
    if (lie) canvas.parentElement.style.height = `${60 + 16 * data.methods.length}px`;
    const names = { grid: { display: false }, ticks: { autoSkip: false, font: { size: 10 } } },
          counts = { beginAtZero: true, title: { display: true, text: what }, ticks: { maxTicksLimit: 7 } };
    return new Chart(canvas, {
      type: "bar",
      data: { labels: data.methods,
              datasets: [{ data: values, backgroundColor: data.methods.map((_, i) => of(i)), maxBarThickness: 46 }] },
      options: {
        indexAxis: lie ? "y" : "x",
        plugins: { legend: { display: false } },
        scales: lie ? { x: counts, y: names } : { x: names, y: counts },
      },
    });
  }

  let charts = [];
  function draw() {
    charts.forEach(chart => chart.destroy());
    themed();
    const each = field => data.methods.map((m, i) => ({ label: m, values: field[i], colour: of(i), dash: dash(i) }));
    charts = [
      line("cull-time", "milliseconds", each(data.cull_ms)),
      line("kept", "objects", each(data.kept).concat(
        [{ label: "visible in truth", values: data.truly_visible, colour: colour("--ink"), width: 2.5 }])),
      ...(data.frame_ms.length ? [line("frame-time", "milliseconds", each(data.frame_ms))] : []),
      bars("triangles", "triangles a view, mean", data.triangles),
      bars("draw-calls", "draw calls a view, mean", data.draw_calls),
    ];
  }
  draw();

  // A table that does not fit looks whole: it says so.
  function hint() {
    const table = document.querySelector(".wide");
    document.querySelector(".hint").hidden = table.scrollWidth <= table.clientWidth;
  }
  hint();
  addEventListener("resize", hint);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
})();
