// The comparison of a sweep's points over its axes: results against an axis, curves over one another, small grounds.
"use strict";

function chooser(title, options, value, changed) {
  const select = element("select", {"aria-label": title});
  for (const [key, text] of options) select.append(element("option", {value: key}, text));
  if (value !== undefined) select.value = value;
  select.addEventListener("change", () => changed(select.value));
  return [select, element("label", {}, `${title} `, select)];
}

// Values of an axis in their order: numbers by size, texts as they come.
function valuesOf(points, axis) {
  const found = [...new Set(points.map((p) => p.axes[axis]).filter((v) => v !== undefined))];
  return found.every((v) => Number.isFinite(Number(v))) ? found.sort((a, b) => a - b) : found;
}

class SweepGroup {
  constructor(host, points, sweep) {
    Object.assign(this, {host, points, sweep});
    this.axes = [...new Set(points.flatMap((p) => Object.keys(p.axes)))].sort(
        (a, b) => valuesOf(points, b).length - valuesOf(points, a).length);
    this.names = [...new Set(points.flatMap((p) => Object.keys(p.results)))].sort();
    const bar = element("div", {class: "controls"});
    const named = (name) => [name, `${name} [${sweep.units[name] || "-"}]`];
    const again = () => this.draw();
    const by = [...this.axes.map((a) => [a, a]), ["point", "point"]];
    let label;
    if (this.names.length) {
      const liked =
          ["surface_settlement", "peak_angle", "q_over_p"].find((n) => this.names.includes(n)) || this.names[0];
      [this.result, label] = chooser("result", this.names.map(named), liked, again);
      bar.append(label);
      [this.along, label] = chooser("against", by, by[0][0], again);
      bar.append(label);
    }
    [this.colour, label] = chooser("colour", by, (by[this.axes.length > 1 ? 1 : 0] || by[0])[0], again);
    bar.append(label);
    this.charts = element("div", {class: "charts"});
    this.table = element("table", {class: "results"});
    host.append(
        bar,
        element(
            "p", {class: "note"},
            "Bars and bands: 95 % bands of the mean over a point's members or packings; none where there is one; curves have none of two members."),
        this.charts, element("div", {class: "scroll"}, this.table));
    this.made = new Map();
    this.draw();
  }

  // The colour of a point by the chosen axis, and the name of its series.
  look(point) {
    const axis = this.colour.value, {colours, many} = this.sweep;
    const values = axis === "point" ? this.points.map((p) => p.name) : valuesOf(this.points, axis);
    const mine = axis === "point" ? point.name : point.axes[axis], k = values.indexOf(mine);
    if (k < 0) return {name: `without ${axis}`, colour: "#888888"};
    const colour =
        values.length <= colours.length ? colours[k] : many[Math.round(k * (many.length - 1) / (values.length - 1))];
    return {name: axis === "point" ? mine : `${axis} = ${mine}`, colour};
  }

  chart(key, spec) {
    if (!this.made.has(key)) {
      const host = element("div", {class: "chart"});
      this.charts.append(host);
      this.made.set(key, new Chart(host, spec));
    }
    const chart = this.made.get(key);
    chart.title.textContent = spec.title;
    chart.spec = spec;
    chart.draw();
  }

  draw() {
    if (this.result) this.chart("results", this.resultSpec());
    for (const [key, chart] of Object.entries(this.sweep.charts)) {
      const series = this.series(key);
      if (series.length) this.chart(key, {...chart, series, alwaysNamed: true});
    }
    this.fill();
  }

  series(key) {
    const seen = new Set();
    return this.points.flatMap((point) => (point.curves[key] || []).map((curve) => {
      const look = this.look(point), silent = seen.has(look.name);
      seen.add(look.name);
      const note = `${point.name}${curve.note ? `, ${curve.note}` : ""}`;
      return {...look, x: curve.x, y: curve.y, band: curve.band, silent, notes: curve.x.map(() => note)};
    }));
  }

  resultSpec() {
    const name = this.result.value, axis = this.along.value;
    const values = axis === "point" ? this.points.map((p) => p.name) : valuesOf(this.points, axis);
    const numeric = axis !== "point" && values.every((v) => Number.isFinite(Number(v)));
    const groups = new Map();
    for (const point of this.points) {
      const mine = axis === "point" ? point.name : point.axes[axis], told = point.results[name];
      if (mine === undefined || !told) continue;
      const look = this.look(point);
      if (!groups.has(look.name)) groups.set(look.name, {...look, points: "line", x: [], y: [], band: [], notes: []});
      const group = groups.get(look.name);
      group.x.push(numeric ? Number(mine) : values.indexOf(mine));
      group.y.push(told[0]);
      group.band.push(told[1]);
      group.notes.push(`${point.name}, ${told[2]} runs`);
    }
    for (const group of groups.values()) {
      if (new Set(group.x).size < group.x.length) group.points = "only";  // several points at one place: no line
      const order = group.x.map((_, k) => k).sort((a, b) => group.x[a] - group.x[b]);
      for (const key of ["x", "y", "band", "notes"]) group[key] = order.map((k) => group[key][k]);
    }
    return {
      title: `${name} against ${axis}`,
      xlabel: axis,
      ylabel: `${name} [${this.sweep.units[name] || "-"}]`,
      alwaysNamed: true,
      series: [...groups.values()],
      xnames: numeric ? undefined : Object.fromEntries(values.map((v, k) => [k, v]))
    };
  }

  // The numbers of the chosen result, and the links to the points' own pages.
  fill() {
    const name = this.result?.value, head = element("tr", {}, element("th", {}, "point"));
    for (const axis of this.axes) head.append(element("th", {}, axis));
    if (name)
      for (const text of [`${name} [${this.sweep.units[name] || "-"}]`, "± half width", "runs"])
        head.append(element("th", {}, text));
    const rows = this.points.map((point) => {
      const first = point.link ? element("a", {href: encodeURI(point.link)}, point.name) : point.name;
      const row = element("tr", {"data-point": point.name}, element("td", {}, first));
      for (const axis of this.axes) row.append(element("td", {}, point.axes[axis] ?? "–"));
      if (name)
        for (const value of point.results[name] || [null, null, null]) row.append(element("td", {}, written(value)));
      return row;
    });
    this.table.replaceChildren(head, ...rows);
  }
}

class SweepView {
  constructor(sweep, colourMaps, report) {
    Object.assign(this, {sweep, colourMaps, report});
    this.groups = [...document.querySelectorAll("[data-group]")].map(
        (host) => new SweepGroup(host, sweep.points.filter((p) => p.group === host.dataset.group), sweep));
    this.small = document.getElementById("small");
    if (this.small) this.ready = this.grounds();
  }

  async grounds() {
    const names = Object.keys(this.sweep.grounds);
    const [select, label] = chooser("point", names.map((n) => [n, n]), names[0], (name) => this.show(name));
    this.choice = select;
    this.place = element("div", {});
    this.small.append(element("div", {class: "controls"}, label), this.place);
    this.unpacked = new Map();
    await this.show(names[0]);
  }

  async show(name) {
    this.place.replaceChildren();
    const host = element("div", {class: "small"}), sliding = element("div", {class: "controls sliding"});
    const pointHost = element("div", {});
    const kept = structuredClone(this.sweep.grounds[name]);  // its texts are dropped when they are unpacked
    this.place.append(sliding, host, pointHost);
    const {view, panel} = await startGround(host, sliding, kept, this.colourMaps, [], pointHost);
    this.report.views[0] = view;
    this.report.panels[0] = panel;
    view.pick(kept.first);
  }
}
