// Draws the charts of a reproduction's page, and moves its sliders.
Chart.defaults.animation = false;
Chart.defaults.maintainAspectRatio = false;
const dark = matchMedia("(prefers-color-scheme: dark)").matches;
Chart.defaults.color = dark ? "#9aa3af" : "#5d6673";
Chart.defaults.borderColor = dark ? "#2d333b" : "#e2e4e8";
const palette = ["#7f8791", "#1f77c8", "#e09a22", "#2a9d6e", "#b04fc0", "#d9553f", "#18a0b0", "#8a6d3b", "#c2557f", "#5b6bd0"];
// What is ours has one colour on the page, beside published figures or alone.
const colour = (series, i) => palette[series.name === "ours" ? 1 : i % palette.length];

for (const canvas of document.querySelectorAll("canvas[data-chart]")) {
  const chart = JSON.parse(canvas.dataset.chart);
  const datasets = chart.series.map((series, i) => ({
    label: series.name, data: series.values,
    borderColor: colour(series, i), backgroundColor: colour(series, i),
    borderWidth: chart.bars ? 0 : 1.75, pointRadius: chart.labels.length < 15 ? 3 : 0, tension: 0.15,
  }));
  legend(new Chart(canvas, {
    type: chart.bars ? "bar" : "line",
    data: { labels: chart.bars ? chart.labels.map((label) => label.split(": ")) : chart.labels, datasets },
    options: {
      interaction: { mode: "index", intersect: false },
      plugins: { legend: { display: false } },
      scales: {
        x: { title: { display: chart.x !== "", text: chart.x }, grid: { display: false } },
        y: { title: { display: chart.y !== "", text: chart.y }, ...(chart.logarithmic ? logarithmicAxis : { beginAtZero: true }) },
      },
    },
  }));
}

for (const slider of document.querySelectorAll(".slider input"))
  slider.addEventListener("input", () => slider.parentElement.style.setProperty("--at", slider.value + "%"));
