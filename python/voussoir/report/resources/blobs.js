// Numbers of the page, the way back from pack.py: base64, gzip, planes of bytes, folded differences in time.
"use strict";

class Blob16 {
  constructor(blob, codes) { Object.assign(this, {frames: blob.frames, count: blob.count, codes, blob}); }

  // The value of a place in a frame; NaN where the run has no number.
  at(frame, place) {
    const {low, step, scale, none} = this.blob;
    const code = this.codes[frame * this.count + place];
    if (code === none) return NaN;
    const bent = low + step * code;
    return scale > 0 ? scale * Math.sinh(bent) : bent;
  }

  frame(frame) {
    const values = new Float64Array(this.count);
    for (let i = 0; i < this.count; ++i) values[i] = this.at(frame, i);
    return values;
  }

  // One place over all frames.
  history(place) { return Array.from({length: this.frames}, (_, frame) => this.at(frame, place)); }
}

async function unpack(blob) {
  const squeezed = Uint8Array.from(atob(blob.data), (letter) => letter.charCodeAt(0));
  const stream = new Blob([squeezed]).stream().pipeThrough(new DecompressionStream("gzip"));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  const total = planes.length / 2, codes = new Uint16Array(total);
  for (let i = 0; i < total; ++i) {
    const folded = (planes[i] << 8) | planes[total + i];
    const before = i < blob.count ? 0 : codes[i - blob.count];
    codes[i] = (before + ((folded >>> 1) ^ -(folded & 1))) & 0xffff;
  }
  blob.data = "";  // the text is not needed a second time
  return new Blob16(blob, codes);
}

// Unpacks every blob of an object of blobs.
async function unpackAll(blobs) {
  const names = Object.keys(blobs), found = await Promise.all(names.map((name) => unpack(blobs[name])));
  return Object.fromEntries(names.map((name, k) => [name, found[k]]));
}

// A number with four digits, as a reader writes it.
function written(value, digits = 4) {
  if (value === null || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size < 1e-4 || size >= 1e6) return value.toExponential(digits - 1).replace(/\.?0+e/, "e").replace("e+", "e");
  const text = value.toPrecision(digits);
  return String(Number(text)).includes("e") ? text : String(Number(text));
}

// Round numbers between two limits for an axis.
function ticks(low, high, about) {
  const span = high - low;
  if (!(span > 0)) return {at: [low], step: 1};
  const raw = span / about, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= raw * 0.999);
  const at = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * span; ++k) at.push(k * step);
  return {at, step};
}

function tickText(value, step) {
  if (Math.abs(value) < step * 1e-6) return "0";
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  return digits > 5 || Math.abs(value) >= 1e6 ? value.toExponential(1) : value.toFixed(digits);
}

function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}
