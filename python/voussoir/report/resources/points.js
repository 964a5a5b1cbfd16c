// The clicked Gauss point: its paths, and its numbers at the slider's state.
"use strict";

class PointPanel {
  constructor(host, view) {
    Object.assign(this, {host, view});
    this.title = element("h3", {}, "A Gauss point");
    this.hint = element("p", {class: "note"}, "Click a point of the ground: its paths and numbers appear here.");
    this.charts = element("div", {class: "charts"});
    this.table = element("table", {class: "numbers"});
    host.append(this.title, this.hint, this.charts, element("div", {class: "scroll"}, this.table));
    this.plots = [];
  }

  // The set whose states a point is followed through: a run, or an ensemble's representative member.
  get member() { return this.view.sets.find((s) => s.followed) || this.view.sets[0]; }
  get mean() { return this.view.sets.find((s) => s.mean); }
  get half() { return this.view.sets.find((s) => s.band); }

  field(name) { return this.view.ground.fields.find((f) => f.name === name); }

  history(set, name, point) {
    const field = this.field(name), {loads} = this.view.ground;
    if (!set || !field) return null;
    return loads.map((_, k) => this.view.value(set, field, k, point)).map((v) => (Number.isFinite(v) ? v : null));
  }

  show(point) {
    this.charts.replaceChildren();
    this.plots = [];
    const [x, y] = this.view.place(point);
    this.title.textContent = `Gauss point ${point} (element ${Math.floor(point / 4)}, point ${point % 4}), ` +
        `at first at x = ${written(x, 3)} m, y = ${written(y)} m`;
    this.hint.textContent = this.mean ? `Lines: ${this.member.title}; dashed with its band: ${this.mean.title}.` : "";
    const {load} = this.view.ground, along = `${load.label}${load.unit === "-" ? " [-]" : ` [${load.unit}]`}`;
    this.path(point);
    for (const [name, title] of [
             ["stress_ratio", "Stress ratio"], ["volumetric_strain", "Volumetric strain"], ["void_ratio", "Void ratio"],
             ["deviatoric_strain", "Deviatoric strain"]]) {
      this.overLoad(point, name, title, along);
    }
    this.update();
  }

  add(spec) {
    const host = element("div", {class: "chart"});
    this.charts.append(host);
    this.plots.push(new Chart(host, {height: 230, ...spec}));
  }

  path(point) {
    const p = this.history(this.member, "mean_stress", point),
          q = this.history(this.member, "deviatoric_stress", point);
    if (!p || !q || p.every((v) => v === null)) return;
    const series = [{name: this.member.title, x: p, y: q, colour: "#0072B2", follows: true}];
    const mean = [this.history(this.mean, "mean_stress", point), this.history(this.mean, "deviatoric_stress", point)];
    if (mean[0] && mean[1])
      series.push({name: this.mean.title, x: mean[0], y: mean[1], colour: "#555555", dash: "5 3"});
    this.add({
      title: "Stress path",
      xlabel: "mean stress p [kPa]",
      ylabel: "deviatoric stress q [kPa]",
      series,
      zero: true,
      xzero: true
    });
  }

  overLoad(point, name, title, along) {
    const y = this.history(this.member, name, point), field = this.field(name);
    if (!y || y.every((v) => v === null)) return;
    const x = this.view.ground.loads, series = [];
    const mean = this.history(this.mean, name, point), half = this.history(this.half, name, point);
    if (mean)
      series.push({
        name: this.mean.title,
        x,
        y: mean,
        band: this.field(name).name === "stress_ratio" ? null : half,
        colour: "#555555",
        dash: "5 3"
      });
    series.push({name: this.member.title, x, y, colour: "#0072B2", follows: true});
    this.add({title, xlabel: along, ylabel: `${field.label.split(",")[0]} [${field.unit}]`, series, marked: true});
  }

  update() {
    const {view} = this, {point, frame} = view;
    if (point === null) return;
    const {loads, fields} = view.ground;
    for (const plot of this.plots) plot.state(frame, loads[frame]);
    const head = element("tr", {}, element("th", {}, `at ${view.stateName(frame)}`));
    for (const set of view.sets) head.append(element("th", {}, set.title));
    const rows = fields.map((field) => {
      const row = element(
          "tr", {"data-field": field.name}, element("td", {}, `${field.label}${field.unit ? ` [${field.unit}]` : ""}`));
      for (const set of view.sets) {
        const value = view.value(set, field, frame, point),
              level = field.levels && !set.band && field.levels[Math.round(value)];
        row.append(element("td", {"data-value": value}, level ? level.name : written(value)));
      }
      return row;
    });
    this.table.replaceChildren(head, ...rows);
  }
}
