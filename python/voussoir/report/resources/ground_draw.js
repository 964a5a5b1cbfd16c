// How the ground view draws itself, and what the reader's hand does to it.
"use strict";

// Each quarter is drawn larger by this on all sides [px], so that no seams show between them; lines would be slower.
const AIR = 0.4;

Object.assign(GroundView.prototype, {
  // Scale and middle of the view: the whole ground unless the reader has moved it.
  fit() {
    const width = this.host.clientWidth || 600, span = (v) => Math.max(...v) - Math.min(...v);
    const wide = span(this.x0), high = span(this.y0);
    const inner = width - MARGIN.left - MARGIN.right;
    const height = Math.min(Math.max(inner * high / wide, 260), 640) + MARGIN.top + MARGIN.bottom;
    const scale = Math.min(inner / wide, (height - MARGIN.top - MARGIN.bottom) / high) * 0.98;
    this.size = {width, height};
    if (!this.zoom) {
      this.zoom = {scale, x: Math.min(...this.x0) + wide / 2, y: Math.min(...this.y0) + high / 2};
    }
  },

  middle() {
    return [(MARGIN.left + this.size.width - MARGIN.right) / 2, (MARGIN.top + this.size.height - MARGIN.bottom) / 2];
  },

  toGround(px, py) {
    const [mx, my] = this.middle();
    return [this.zoom.x + (px - mx) / this.zoom.scale, this.zoom.y - (py - my) / this.zoom.scale];
  },

  toCanvas(x, y) {
    const [mx, my] = this.middle();
    return [mx + (x - this.zoom.x) * this.zoom.scale, my - (y - this.zoom.y) * this.zoom.scale];
  },

  // Half widths of bands have no sign, and so no colours of two signs.
  map(field) { return this.colourMaps[this.shown.band ? "viridis" : field.map]; },

  // The function that gives a value its colour; what does not depend on the value is looked up once.
  palette() {
    const field = this.field, map = this.map(field), [low, high] = this.limits, none = "#bbbbbb";
    if (field.levels && !this.shown.band) return (value) => field.levels[Math.round(value)]?.colour || none;
    const slope = 256 / (high - low);
    return (value) =>
               (Number.isFinite(value) ? map[Math.min(255, Math.max(0, Math.floor(slope * (value - low))))] : none);
  },

  draw() {
    this.fit();
    this.center = this.middle();
    const {width, height} = this.size, ratio = window.devicePixelRatio || 1;
    const [wide, high] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (this.canvas.width !== wide ||
        this.canvas.height !== high) {  // a new size makes the browser lay the page out anew
      Object.assign(this.canvas, {width: wide, height: high});
      Object.assign(this.canvas.style, {width: `${width}px`, height: `${height}px`});
    }
    const pen = this.canvas.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.save();
    pen.beginPath();
    pen.rect(MARGIN.left, MARGIN.top, width - MARGIN.left - MARGIN.right, height - MARGIN.top - MARGIN.bottom);
    pen.clip();
    this.drawPoints(pen);
    pen.restore();
    this.drawAxes(pen);
    this.drawColourBar(pen);
  },

  path(pen, point) {
    const c = this.corners, {scale, x, y} = this.zoom, [mx, my] = this.center;
    const first = 8 * point, px = (k) => mx + (c[first + k] - x) * scale,
          py = (k) => my - (c[first + k + 1] - y) * scale;
    const cx = (px(0) + px(2) + px(4) + px(6)) / 4, cy = (py(0) + py(2) + py(4) + py(6)) / 4;
    for (let k = 0; k < 8; k += 2) {
      const qx = px(k) + (px(k) > cx ? AIR : -AIR), qy = py(k) + (py(k) > cy ? AIR : -AIR);
      if (k === 0)
        pen.moveTo(qx, qy);
      else
        pen.lineTo(qx, qy);
    }
    pen.closePath();
  },

  // Points of one colour are drawn together.
  drawPoints(pen) {
    const groups = new Map(), colourOf = this.palette();
    this.values.forEach((value, p) => {
      if (!this.isThere(p)) return;
      const colour = colourOf(value);
      if (groups.has(colour))
        groups.get(colour).push(p);
      else
        groups.set(colour, [p]);
    });
    for (const [colour, members] of groups) {
      pen.beginPath();
      for (const p of members) this.path(pen, p);
      pen.fillStyle = colour;
      pen.fill();
    }
    this.drawInterfaces(pen);
    if (this.point === null) return;
    for (const [colour, line] of [["white", 5], ["black", 2]]) {
      pen.beginPath();
      this.path(pen, this.point);
      pen.strokeStyle = colour;
      pen.lineWidth = line;
      pen.stroke();
    }
  },

  // Lines between the regions of a scene: three nodes and two elements each.
  drawInterfaces(pen) {
    if (!this.ground.interfaces) return;
    const [x, y] = this.deformed;
    pen.beginPath();
    for (const [a, m, b, one, other] of this.ground.interfaces) {
      if (!this.isThere(4 * one) || !this.isThere(4 * other)) continue;
      [a, m, b].forEach((n, k) => {
        const at = this.toCanvas(x[n], y[n]);
        if (k === 0)
          pen.moveTo(...at);
        else
          pen.lineTo(...at);
      });
    }
    pen.strokeStyle = "black";
    pen.lineWidth = 1.5;
    pen.stroke();
  },

  drawAxes(pen) {
    const {width, height} = this.size, bottom = height - MARGIN.bottom, right = width - MARGIN.right;
    const [x0, y1] = this.toGround(MARGIN.left, MARGIN.top), [x1, y0] = this.toGround(right, bottom);
    pen.strokeStyle = pen.fillStyle = "#333";
    pen.lineWidth = 1;
    pen.font = "12px sans-serif";
    pen.strokeRect(MARGIN.left, MARGIN.top, right - MARGIN.left, bottom - MARGIN.top);
    pen.textAlign = "center";
    const along = ticks(x0, x1, Math.max(3, (right - MARGIN.left) / 80)),
          up = ticks(y0, y1, Math.max(3, (bottom - MARGIN.top) / 70));
    for (const x of along.at) pen.fillText(tickText(x, along.step), this.toCanvas(x, 0)[0], bottom + 15);
    const from = this.ground.tunnel ? "the tunnel's axis" : "the left edge";
    pen.fillText(this.ground.scene ? "x [m]" : `distance from ${from} x [m]`, (MARGIN.left + right) / 2, bottom + 32);
    pen.textAlign = "right";
    for (const y of up.at) pen.fillText(tickText(y, up.step), MARGIN.left - 5, this.toCanvas(0, y)[1] + 4);
    this.upright(pen, this.ground.scene ? "y [m]" : "height above the base y [m]", 12, (MARGIN.top + bottom) / 2);
  },

  upright(pen, text, x, y) {
    pen.save();
    pen.translate(x, y);
    pen.rotate(-Math.PI / 2);
    pen.textAlign = "center";
    pen.fillText(text, 0, 0);
    pen.restore();
  },

  drawColourBar(pen) {
    const {width, height} = this.size, field = this.field, left = width - MARGIN.right + 14;
    const top = MARGIN.top + 8, bottom = height - MARGIN.bottom - 8;
    pen.font = "12px sans-serif";
    pen.textAlign = "left";
    if (field.levels && !this.shown.band) {
      field.levels.forEach((level, k) => {
        pen.fillStyle = level.colour;
        pen.fillRect(left - 6, top + 20 * k, 12, 12);
        pen.fillStyle = "#333";
        pen.fillText(level.name.split(",")[0].slice(0, 14), left + 9, top + 20 * k + 10, MARGIN.right - 24);
      });
      return;
    }
    const map = this.map(field), [low, high] = this.limits, rise = (bottom - top) / 256;
    map.forEach((colour, k) => {
      pen.fillStyle = colour;
      pen.fillRect(left, bottom - (k + 1) * rise, 14, rise + 0.6);
    });
    pen.fillStyle = pen.strokeStyle = "#333";
    pen.strokeRect(left, top, 14, bottom - top);
    const marks = ticks(low, high, Math.max(3, (bottom - top) / 50));
    for (const value of marks.at) {
      pen.fillText(tickText(value, marks.step), left + 18, bottom - (value - low) / (high - low) * (bottom - top) + 4);
    }
    const unit = field.unit && field.unit !== "" ? ` [${field.unit}]` : "";
    this.upright(pen, `${this.shown.band ? "half width: " : ""}${field.label}${unit}`, width - 6, (top + bottom) / 2);
  },

  listen() {
    const place = (event) => {
      const box = this.canvas.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    let held = null;
    this.canvas.addEventListener("pointerdown", (event) => {
      held = {from: place(event), x: this.zoom.x, y: this.zoom.y, moved: false};
    });
    this.canvas.addEventListener("pointermove", (event) => {
      const [px, py] = place(event);
      if (held && event.buttons) {
        const dx = px - held.from[0], dy = py - held.from[1];
        held.moved = held.moved || Math.hypot(dx, dy) > 4;
        if (!held.moved) return;
        this.zoom = {...this.zoom, x: held.x - dx / this.zoom.scale, y: held.y + dy / this.zoom.scale};
        this.draw();
      }
      this.hover(px, py);
    });
    this.canvas.addEventListener("pointerup", (event) => {
      const point = held && !held.moved ? this.pointAt(...place(event)) : null;
      held = null;
      if (point !== null) this.pick(point);
    });
    this.canvas.addEventListener("pointerleave", () => {
      this.tip.hidden = true;
    });
    this.canvas.addEventListener("dblclick", () => {
      this.zoom = null;
      this.draw();
    });
    this.canvas.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && document.activeElement !== this.canvas)
        return;  // the page scrolls until the ground is clicked
      event.preventDefault();
      const [px, py] = place(event), [wx, wy] = this.toGround(px, py);
      this.zoom.scale *= event.deltaY < 0 ? 1.2 : 1 / 1.2;
      const [nx, ny] = this.toGround(px, py);
      this.zoom.x += wx - nx;
      this.zoom.y += wy - ny;
      this.draw();
    }, {passive: false});
    new ResizeObserver(() => {
      if (this.size && this.host.clientWidth !== this.size.width) {
        this.zoom = null;
        this.draw();
      }
    }).observe(this.host);
  },

  hover(px, py) {
    const point = this.pointAt(px, py), field = this.field;
    this.tip.hidden = point === null;
    if (point === null) return;
    const value = this.values[point], level = field.levels && !this.shown.band && field.levels[Math.round(value)];
    this.tip.textContent =
        `point ${point}: ${level ? level.name : `${written(value)} ${field.unit === "-" ? "" : field.unit}`}`;
    Object.assign(this.tip.style, {left: `${Math.min(px + 14, this.size.width - 150)}px`, top: `${py + 10}px`});
  },
});
