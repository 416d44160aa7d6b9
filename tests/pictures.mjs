// Pictures as pixels, and how different two of them are.
import assert from 'node:assert/strict';
import { PNG } from 'pngjs';

/** Decodes a PNG: {width, height, data}, RGBA. */
export function decode(bytes) {
  return PNG.sync.read(Buffer.from(bytes));
}

/** The share of pixels of which a channel differs by more than `step` of 255. */
export function shareThatDiffers(a, b, step) {
  sameSize(a, b);
  let count = 0;
  for (let i = 0; i < a.data.length; i += 4) {
    const differs = [0, 1, 2].some((c) => Math.abs(a.data[i + c] - b.data[i + c]) > step);
    if (differs) count += 1;
  }
  return count / (a.data.length / 4);
}

/**
 * The mean colour difference as people see it: CIE76 ΔE of sRGB pixels. Below 1 nobody sees one;
 * black and white are 100 apart.
 */
export function meanDeltaE(a, b) {
  sameSize(a, b);
  let sum = 0;
  for (let i = 0; i < a.data.length; i += 4) {
    const [p, q] = [lab(a.data, i), lab(b.data, i)];
    sum += Math.hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
  }
  return sum / (a.data.length / 4);
}

/** How many different colours there are, at most `most`: tells a picture from a blank. */
export function colours(picture, most = 1000) {
  const seen = new Set();
  for (let i = 0; i < picture.data.length && seen.size < most; i += 4) {
    seen.add(picture.data.readUInt32BE(i) >>> 8);
  }
  return seen.size;
}

/** How many pixels are within `step` of a colour, in each channel. */
export function countNear(picture, [r, g, b], step) {
  let count = 0;
  const { data } = picture;
  for (let i = 0; i < data.length; i += 4) {
    const off = [data[i] - r, data[i + 1] - g, data[i + 2] - b];
    if (off.every((d) => Math.abs(d) <= step)) count += 1;
  }
  return count;
}

/** A picture of another size, by the mean of the pixels that fall together. */
export function shrink(picture, width, height) {
  const out = new PNG({ width, height });
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const box = {
        x0: Math.floor((x * picture.width) / width),
        x1: Math.max(Math.floor(((x + 1) * picture.width) / width), Math.floor((x * picture.width) / width) + 1),
        y0: Math.floor((y * picture.height) / height),
        y1: Math.max(Math.floor(((y + 1) * picture.height) / height), Math.floor((y * picture.height) / height) + 1),
      };
      const sum = [0, 0, 0];
      for (let v = box.y0; v < box.y1; v++) {
        for (let u = box.x0; u < box.x1; u++) {
          for (let c = 0; c < 3; c++) sum[c] += picture.data[4 * (v * picture.width + u) + c];
        }
      }
      const count = (box.x1 - box.x0) * (box.y1 - box.y0);
      for (let c = 0; c < 3; c++) out.data[4 * (y * width + x) + c] = Math.round(sum[c] / count);
      out.data[4 * (y * width + x) + 3] = 255;
    }
  }
  return out;
}

function sameSize(a, b) {
  assert.deepEqual([a.width, a.height], [b.width, b.height], 'sizes of the pictures');
}

function lab(data, i) {
  const [r, g, b] = [0, 1, 2].map((c) => {
    const v = data[i + c] / 255;
    return v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
  });
  const f = (t) => (t > 216 / 24389 ? Math.cbrt(t) : (t * 24389) / 27 / 116 + 16 / 116);
  const x = f((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.95047);
  const y = f(0.2126 * r + 0.7152 * g + 0.0722 * b);
  const z = f((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.08883);
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}
