// Starts the page: reads its data, makes its views, and joins the slider with the curves and the clicked point.
"use strict";

// Unpacks the curves of a chart that move with the slider.
async function readySpec(spec) {
  for (const series of spec.series) {
    if (!series.frames) continue;
    for (const name of ["y", "band", "further"])
      if (series[name]) series[name] = await unpack(series[name]);
  }
  return spec;
}

async function startGround(host, sliding, ground, colourMaps, charts, panelHost) {
  let panel = null;
  const calls = {
    changed: (frame) => {
      for (const chart of charts) chart.state(frame, ground.loads[frame]);
      panel?.update();
    },
    picked: (point) => panel?.show(point),
  };
  const view = await GroundView.make(host, sliding, ground, colourMaps, calls);
  if (panelHost) panel = new PointPanel(panelHost, view);
  return {view, panel};
}

async function start() {
  const data = JSON.parse(document.getElementById("data").textContent);
  const report = (window.report = {ready: false, data, views: [], charts: [], panels: []});
  for (const host of document.querySelectorAll("[data-chart]")) {
    report.charts.push(new Chart(host, await readySpec(data.charts[Number(host.dataset.chart)])));
  }
  const host = document.getElementById("ground");
  if (host && data.ground) {
    const [sliding, point] = ["slider", "point"].map((name) => document.getElementById(name));
    const {view, panel} = await startGround(host, sliding, data.ground, data.colourMaps, report.charts, point);
    report.views.push(view);
    report.panels.push(panel);
    if (data.first_point !== undefined) view.pick(data.first_point);
  }
  if (data.sweep) {
    report.sweep = new SweepView(data.sweep, data.colourMaps, report);
    await report.sweep.ready;
  }
  for (const picture of document.querySelectorAll("figure img")) {
    picture.addEventListener("click", () => picture.closest("figure").classList.toggle("large"));
  }
  report.ready = true;
  report.readyAfter = performance.now();
  document.body.dataset.ready = "yes";
}

window.addEventListener("DOMContentLoaded", () => start().catch((error) => {
  document.getElementById("failed").textContent =
      `The page could not start: ${error.message}. It needs a browser of 2023 or newer.`;
  console.error(error);
}));
