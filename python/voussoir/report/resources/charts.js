// Curves: lines, points and bands in an SVG, with axes, a legend whose entries hide their curve, and a reading of the
// nearest point. A series has x and y as lists; where `frames` stands, y and band are blobs with a row for each state.
"use strict";

class Chart {
  constructor(host, spec) {
    Object.assign(this, {host, spec, frame: null, mark: null, hidden: new Set()});
    this.title = element("h4", {}, spec.title);
    this.box = element("div", {class: "plot"});
    this.tip = element("div", {class: "tip", hidden: ""});
    this.box.append(this.tip);
    this.keys = element("div", {class: "keys"});
    host.append(this.title, this.box, this.keys);
    if (spec.note) host.append(element("p", {class: "note"}, spec.note));
    this.box.addEventListener("pointermove", (event) => this.hover(event));
    this.box.addEventListener("pointerleave", () => {
      this.tip.hidden = true;
    });
    new ResizeObserver(() => {
      if (this.box.clientWidth !== this.width) this.draw();
    }).observe(this.box);
    this.draw();
  }

  // The state of the slider: its number, and the load at which curves over the load are marked.
  state(frame, load) {
    this.frame = frame;
    this.mark = this.spec.marked ? load : null;
    if (this.spec.series.some((s) => s.frames))
      this.draw();
    else
      this.over();
  }

  set(series) {
    this.spec.series = series;
    this.draw();
  }

  // The numbers of a series as they are drawn now.
  numbers(series) {
    if (!series.frames) return series;
    const frame = this.frame ?? series.y.frames - 1, scale = series.factor || 1;
    const row = (blob) => Array.from(blob.frame(frame), (v) => (Number.isFinite(v) ? scale * v : null));
    return {
      ...series,
      y: row(series.y),
      band: series.band && row(series.band),
      further: series.further && row(series.further)
    };
  }

  limits(drawn) {
    const x = [], y = [], {spec} = this;
    for (const s of drawn) {
      s.x.forEach((v, k) => {
        if (v === null || s.y[k] === null) return;
        x.push(v);
        y.push(s.y[k]);
        const half = (s.further || s.band)?.[k];
        if (half) y.push(s.y[k] - half, s.y[k] + half);
      });
    }
    // The axis of a curve that moves with the slider stays where it is.
    const held = spec.ylimits || [], low = (v, least) => v.reduce((a, b) => Math.min(a, b), least);
    const high = (v, most) => v.reduce((a, b) => Math.max(a, b), most);
    let y0 = low([...y, ...held], Infinity), y1 = high([...y, ...held], -Infinity);
    if (spec.zero) {
      y0 = Math.min(y0, 0);
      y1 = Math.max(y1, 0);
    }
    let x0 = low(x, Infinity), x1 = high(x, -Infinity);
    if (spec.xzero) {
      x0 = Math.min(x0, 0);
      x1 = Math.max(x1, 0);
    }
    if (spec.xnames) {  // room for the names of the first and the last place
      x0 -= 0.5;
      x1 += 0.5;
    }
    if (!(x1 > x0)) {
      x0 = Number.isFinite(x0) ? x0 - 0.5 : 0;
      x1 = x0 + 1;
    }
    if (!(y1 > y0)) {
      const m = Number.isFinite(y0) ? y0 : 0, d = Math.abs(m) * 0.1 || 1;
      y0 = m - d;
      y1 = m + d;
    }
    const air = 0.04 * (y1 - y0);
    return {x0, x1, y0: spec.zero && y0 === 0 ? 0 : y0 - air, y1: spec.zero && y1 === 0 ? 0 : y1 + air};
  }

  draw() {
    const {spec} = this, width = (this.width = this.box.clientWidth || 400), height = spec.height || 270;
    const drawn = (this.drawn = spec.series.filter((s) => !this.hidden.has(s.name)).map((s) => this.numbers(s)));
    const limits = (this.at = this.limits(drawn)), left = 62, right = width - 12, top = 8, bottom = height - 42;
    const logx = spec.logx && limits.x0 > 0;
    const along = (v) =>
        (logx ? Math.log(v / limits.x0) / Math.log(limits.x1 / limits.x0) : (v - limits.x0) / (limits.x1 - limits.x0));
    this.px = (v) => left + along(v) * (right - left);
    const up = (v) => (v - limits.y0) / (limits.y1 - limits.y0);
    this.py = (v) => (spec.down ? top + up(v) * (bottom - top) : bottom - up(v) * (bottom - top));
    const parts = this.axes(limits, left, right, top, bottom, logx);
    for (const s of drawn) parts.push(...this.bands(s));
    for (const s of drawn) parts.push(this.line(s));
    parts.push("<g></g>");
    const svg = `<svg width="${width}" height="${height}" role="img" aria-label="${escaped(spec.title)}">${
        parts.join("")}</svg>`;
    this.box.querySelector("svg")?.remove();
    this.box.insertAdjacentHTML("afterbegin", svg);
    this.over();
    this.legend();
  }

  // What moves with the slider: the mark, and the dots of paths.
  over() {
    const x = this.mark === null ? null : this.px(this.mark), bottom = (this.spec.height || 270) - 42;
    const mark = x === null ? "" : `<line class="mark" x1="${x}" x2="${x}" y1="8" y2="${bottom}"/>`;
    this.box.querySelector("svg > g").innerHTML = mark + this.drawn.map((s) => this.dot(s)).join("");
  }

  axes(limits, left, right, top, bottom, logx) {
    const parts = [`<rect class="frame" x="${left}" y="${top}" width="${right - left}" height="${bottom - top}"/>`];
    let below = ticks(limits.x0, limits.x1, Math.max(3, (right - left) / 75));
    if (logx) {
      const decades = [];
      for (let d = Math.floor(Math.log10(limits.x0)); d <= Math.ceil(Math.log10(limits.x1)); ++d)
        for (const m of [1, 2, 5]) decades.push(m * 10 ** d);
      below = {at: decades.filter((v) => v >= limits.x0 * 0.999 && v <= limits.x1 * 1.001), step: null};
    }
    if (this.spec.xnames) below = {at: Object.keys(this.spec.xnames).map(Number), step: null};
    for (const x of below.at) {
      parts.push(`<line class="grid" x1="${this.px(x)}" x2="${this.px(x)}" y1="${top}" y2="${bottom}"/>`);
      const text = this.spec.xnames ? this.spec.xnames[x] ?? "" : below.step ? tickText(x, below.step) : written(x, 3);
      parts.push(`<text x="${this.px(x)}" y="${bottom + 16}" text-anchor="middle">${escaped(text)}</text>`);
    }
    const beside = ticks(limits.y0, limits.y1, Math.max(3, (bottom - top) / 45));
    for (const y of beside.at) {
      parts.push(`<line class="grid" x1="${left}" x2="${right}" y1="${this.py(y)}" y2="${this.py(y)}"/>`);
      parts.push(`<text x="${left - 6}" y="${this.py(y) + 4}" text-anchor="end">${tickText(y, beside.step)}</text>`);
    }
    parts.push(
        `<text x="${(left + right) / 2}" y="${bottom + 34}" text-anchor="middle">${escaped(this.spec.xlabel)}</text>`);
    parts.push(`<text transform="translate(14 ${(top + bottom) / 2}) rotate(-90)" text-anchor="middle">${
        escaped(this.spec.ylabel)}</text>`);
    return parts;
  }

  // The wider band, of one further member, lies below the band of the mean.
  bands(s) {
    return [["further", 0.13], ["band", 0.3]].filter(([kind]) => s[kind] && !s.points).map(([kind, alpha]) => {
      const there = s.x.map((_, k) => k).filter((k) => s.y[k] !== null && s[kind][k] !== null && s.x[k] !== null);
      const edge = (sign, order) =>
          order.map((k) => `${this.px(s.x[k]).toFixed(1)},${this.py(s.y[k] + sign * s[kind][k]).toFixed(1)}`);
      return `<polygon class="${kind}" points="${
              [...edge(1, there), ...edge(-1, there.slice().reverse())].join(
                  " ")}" fill="${s.colour}" fill-opacity="${alpha}"/>`;
    });
  }

  line(s) {
    let path = "", open = false;
    s.x.forEach((x, k) => {
      if (x === null || s.y[k] === null) {
        open = false;
        return;
      }
      path += `${open ? "L" : "M"}${this.px(x).toFixed(1)} ${this.py(s.y[k]).toFixed(1)}`;
      open = true;
    });
    const dots = s.points ?
        s.x.map(
               (x, k) =>
                   (x === null || s.y[k] === null ? "" :
                                                    `<circle cx="${this.px(x).toFixed(1)}" cy="${
                                                        this.py(s.y[k]).toFixed(1)}" r="3.5" fill="${s.colour}"/>`))
            .join("") :
        "";
    const bars = s.points && s.band ?
        s.x.map(
               (x, k) =>
                   (x === null || s.y[k] === null || s.band[k] === null ?
                        "" :
                        `<line x1="${this.px(x)}" x2="${this.px(x)}" y1="${this.py(s.y[k] - s.band[k])}" y2="${
                            this.py(s.y[k] + s.band[k])}" stroke="${s.colour}"/>`))
            .join("") :
        "";
    const stroke = s.points === "only" ? "none" : s.colour;
    return `<path d="${path}" fill="none" stroke="${stroke}" stroke-width="${s.width || 1.8}" stroke-dasharray="${
        s.dash || ""}"/>${dots}${bars}`;
  }

  // A path that is no function of the load shows the slider's state by a dot.
  dot(s) {
    if (!s.follows || this.frame === null) return "";
    const x = s.x[this.frame], y = s.y[this.frame];
    return x == null || y == null ?
        "" :
        `<circle class="now" cx="${this.px(x)}" cy="${this.py(y)}" r="5" fill="${s.colour}"/>`;
  }

  legend() {
    const named = this.spec.series.filter((s) => s.name && !s.silent);
    this.keys.replaceChildren(...(named.length < 2 && !this.spec.alwaysNamed ? [] : named.map((s) => {
      const key = element("button", {type: "button", class: this.hidden.has(s.name) ? "off" : ""});
      const swatch = element("i");
      swatch.style.borderTop = `3px ${s.dash ? "dashed" : "solid"} ${s.colour}`;
      key.append(swatch, s.name);
      key.addEventListener("click", () => {
        if (!this.hidden.delete(s.name)) this.hidden.add(s.name);
        this.draw();
      });
      return key;
    })));
  }

  hover(event) {
    const box = this.box.getBoundingClientRect(), mx = event.clientX - box.left, my = event.clientY - box.top;
    let best = null, nearest = 900;
    for (const s of this.drawn) {
      s.x.forEach((x, k) => {
        if (x === null || s.y[k] === null) return;
        const d = (this.px(x) - mx) ** 2 + (this.py(s.y[k]) - my) ** 2;
        if (d < nearest) {
          nearest = d;
          best = [s, k];
        }
      });
    }
    this.tip.hidden = best === null;
    if (best === null) return;
    const [s, k] = best, half = s.band && s.band[k] !== null ? ` ± ${written(s.band[k], 3)}` : "";
    this.tip.textContent = `${s.name ? `${s.name}: ` : ""}${this.spec.xnames?.[s.x[k]] ?? written(s.x[k])}, ${
        written(s.y[k])}${half}${s.notes?.[k] ? ` (${s.notes[k]})` : ""}`;
    Object.assign(this.tip.style, {left: `${Math.min(mx + 12, this.width - 170)}px`, top: `${my + 12}px`});
  }
}

function escaped(text) {
  return String(text).replace(/[&<>"]/g, (c) => ({"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;"})[c]);
}
