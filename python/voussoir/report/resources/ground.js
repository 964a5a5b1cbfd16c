// The ground over the deformed mesh: one colour a Gauss point, because each point is one RVE and smoothing would hide
// how localised a field is. Wheel and drag move the view, a double click resets it, a click picks a point.
"use strict";

const MARGIN = {
  left: 48,
  right: 92,
  top: 8,
  bottom: 40
};

class GroundView {
  // `changed(frame)` and `picked(point)` are called when the reader moves the slider or clicks.
  static async make(host, sliding, ground, colourMaps, calls = {}) {
    const view = new GroundView();
    Object.assign(view, {host, sliding, ground, colourMaps, calls, point: null, zoom: null, times: []});
    view.mesh = await unpackAll({x: ground.x, y: ground.y, connectivity: ground.connectivity});
    view.x0 = view.mesh.x.frame(0);
    view.y0 = view.mesh.y.frame(0);
    view.nodes = Uint32Array.from(view.mesh.connectivity.frame(0));
    view.points = view.nodes.length / 2;
    if (ground.there) view.there = await unpack(ground.there);  // which elements are not dug out, of a scene
    view.sets = await Promise.all(ground.sets.map(async (set) => ({...set, data: await unpackAll(set.blobs)})));
    view.controls();
    view.listen();
    view.update();
    return view;
  }

  controls() {
    const choice = (title, options, value) => {
      const select = element("select", {"aria-label": title});
      for (const [key, text] of options) select.append(element("option", {value: key}, text));
      select.value = value;
      select.addEventListener("change", () => this.update());
      return [select, element("label", {}, `${title} `, select)];
    };
    const {fields, loads, load, sets} = this.ground;
    const bar = element("div", {class: "controls"});
    let label;
    [this.set, label] = choice("show", sets.map((s, k) => [k, s.title]), 0);
    if (sets.length > 1) bar.append(label);
    const first = fields.find((f) => f.name === "deviatoric_strain") || fields[0];
    [this.menu, label] =
        choice("field", fields.map((f) => [f.name, `${f.label}${f.unit ? ` [${f.unit}]` : ""}`]), first.name);
    bar.append(label);
    [this.scale, label] =
        choice("deformation", [0, 1, 2, 5, 10, 20, 50, 100].map((m) => [m, `× ${m}`]), this.visibleScale());
    bar.append(label);
    [this.range, label] = choice("colours", [["all", "same for all states"], ["this", "this state's"]], "all");
    bar.append(label);
    this.slider = element("input", {type: "range", min: 0, max: loads.length - 1, step: 1, "aria-label": load.label});
    this.slider.value = loads.length - 1;
    this.slider.addEventListener("input", () => this.update());
    this.told = element("output", {class: "load"});
    this.sliding.append(this.slider, this.told);
    this.canvas = element("canvas", {class: "ground", tabindex: 0});
    this.tip = element("div", {class: "tip", hidden: ""});
    this.note = element("p", {class: "note"});
    this.host.append(bar, element("div", {class: "canvas"}, this.canvas, this.tip), this.note);
  }

  // The state of a frame: the stage of a scene, or a load.
  stateName(frame) {
    const {loads, load, names} = this.ground;
    return names ? names[frame] : `${load.label} = ${written(loads[frame])}${load.unit === "-" ? "" : ` ${load.unit}`}`;
  }

  // False for a point whose element has been dug out.
  isThere(point) { return !this.there || this.there.at(this.frame, Math.floor(point / 4)) > 0.5; }

  // A deformation of about 2 % of the width is visible.
  visibleScale() {
    const data = this.sets[0].data, last = this.ground.loads.length - 1;
    const ux = data.ux.frame(last), uy = data.uy.frame(last);
    let largest = 0;
    for (let i = 0; i < ux.length; ++i) largest = Math.max(largest, Math.hypot(ux[i], uy[i]));
    const width = Math.max(...this.x0) - Math.min(...this.x0);
    if (!(largest > 0) || largest > 0.005 * width) return 1;
    return [100, 50, 20, 10, 5, 2].find((m) => m * largest <= 0.03 * width) || 1;
  }

  get frame() { return Number(this.slider.value); }
  get field() { return this.ground.fields.find((f) => f.name === this.menu.value); }
  get shown() { return this.sets[Number(this.set.value)]; }

  // The displacement of a Gauss point, from the nodes of its element.
  moved(data, frame, point) {
    const at = 8 * Math.floor(point / 4), weights = this.ground.weights[point % 4];
    let ux = 0, uy = 0;
    for (let n = 0; n < 8; ++n) {
      ux += weights[n] * data.ux.at(frame, this.nodes[at + n]);
      uy += weights[n] * data.uy.at(frame, this.nodes[at + n]);
    }
    return [ux, uy];
  }

  // A field at a point in its own unit; NaN where it has no value.
  value(set, field, frame, point) {
    const data = set.data, stored = data[field.name];
    if (stored) return (set.band ? Math.abs(field.factor) : field.factor) * stored.at(frame, point);
    if (set.band && !(field.name in set.limits)) return NaN;
    if (field.name === "stress_ratio") {
      if (!data.mean_stress || !data.deviatoric_stress) return NaN;
      const p = data.mean_stress.at(frame, point);
      return p > this.ground.least_pressure ? data.deviatoric_stress.at(frame, point) / p : NaN;
    }
    if (!["displacement", "settlement", "sideways"].includes(field.name)) return NaN;
    const [ux, uy] = this.moved(data, frame, point);
    return field.name === "displacement" ? Math.hypot(ux, uy) : field.name === "sideways" ? ux : set.band ? uy : -uy;
  }

  // Where the Gauss point stood before anything moved [m].
  place(point) {
    const at = 8 * Math.floor(point / 4), weights = this.ground.weights[point % 4];
    return [this.x0, this.y0].map((x) => weights.reduce((sum, w, n) => sum + w * x[this.nodes[at + n]], 0));
  }

  // The corners of every Gauss point's quarter of its element, on the deformed mesh: 8 numbers a point.
  quarters() {
    // A band has no shape of its own: it is drawn on the ground of the first set.
    const data = this.shown.band ? this.sets[0].data : this.shown.data;
    const m = Number(this.scale.value), ux = data.ux.frame(this.frame), uy = data.uy.frame(this.frame);
    const x = this.x0.map((v, i) => v + m * ux[i]), y = this.y0.map((v, i) => v + m * uy[i]);
    this.deformed = [x, y];
    const corners = new Float64Array(8 * this.points);
    for (let e = 0; e < this.points / 4; ++e) {
      const n = this.nodes.subarray(8 * e, 8 * e + 8);
      let cx = 0, cy = 0;  // the shape functions at the centre: 1/2 of a midside, -1/4 of a corner
      for (let a = 0; a < 4; ++a) {
        cx += 0.5 * x[n[4 + a]] - 0.25 * x[n[a]];
        cy += 0.5 * y[n[4 + a]] - 0.25 * y[n[a]];
      }
      for (let a = 0; a < 4; ++a) {
        const next = n[4 + a], before = n[4 + (a + 3) % 4];
        corners.set([x[n[a]], y[n[a]], x[next], y[next], cx, cy, x[before], y[before]], 8 * (4 * e + a));
      }
    }
    return corners;
  }

  update() {
    const start = performance.now(), {frame, field, shown} = this;
    this.corners = this.quarters();
    this.values = Float64Array.from({length: this.points}, (_, p) => this.value(shown, field, frame, p));
    this.limits = this.range.value === "this" ? this.ownLimits(field) : shown.limits[field.name] || [0, 1];
    this.draw();
    this.told.textContent = this.stateName(frame);
    this.note.textContent = shown.note || "";
    this.calls.changed?.(frame);
    this.times.push(performance.now() - start);
  }

  ownLimits(field) {
    const finite = this.values.filter(Number.isFinite).sort();
    if (!finite.length) return [0, 1];
    const [low, high] = [0.002, 0.998].map((q) => finite[Math.round(q * (finite.length - 1))]);
    const size = Math.max(Math.abs(low), Math.abs(high)) || 1e-12;
    return field.symmetric && !this.shown.band ? [-size, size] : [low, high > low ? high : low + 1e-9 * size];
  }

  pick(point) {
    this.point = point;
    this.draw();
    this.calls.picked?.(point);
  }

  // The point whose drawn quarter holds a place of the canvas, or null.
  pointAt(px, py) {
    const [wx, wy] = this.toGround(px, py), c = this.corners;
    for (let p = 0; p < this.points; ++p) {
      let inside = false;
      for (let a = 0, b = 3; a < 4; b = a++) {
        const xa = c[8 * p + 2 * a], ya = c[8 * p + 2 * a + 1], xb = c[8 * p + 2 * b], yb = c[8 * p + 2 * b + 1];
        if (ya > wy !== yb > wy && wx < xa + (xb - xa) * (wy - ya) / (yb - ya)) inside = !inside;
      }
      if (inside && this.isThere(p)) return p;
    }
    return null;
  }
}
