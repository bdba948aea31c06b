// SPDX-License-Identifier: Apache-2.0
// Texels against texels: colours in linear light, normals in degrees.

export function linearOfSrgb(value) {
  return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
}

export function srgbOfLinear(value) {
  const held = Math.min(Math.max(value, 0), 1);
  return held <= 0.0031308 ? held * 12.92 : 1.055 * held ** (1 / 2.4) - 0.055;
}

export function sameSize(read, truth) {
  if (read.error) return {ok: false, says: read.error};
  const ok = read.width === truth.width && read.height === truth.height;
  return {ok, says: `${read.width} x ${read.height} pixels${ok ? '' : `, not ${truth.width} x ${truth.height}`}`};
}

/** The upper left of a picture whose sides were filled up to multiples of 4. */
export function withoutPadding(pixels, {width, height}) {
  const whole = (side) => 4 * Math.ceil(side / 4);
  if (pixels.error || pixels.width !== whole(width) || pixels.height !== whole(height)) return pixels;
  const data = new Float32Array(width * height * pixels.channels);
  const row = width * pixels.channels;
  for (let y = 0; y < height; y += 1) data.set(pixels.data.subarray(y * pixels.width * pixels.channels).subarray(0, row), y * row);
  return {...pixels, width, height, data};
}

/** Differences of channels [[channel of read, of truth], ...] by value(read) and value(truth). */
export function difference(read, truth, channels, {ofRead = (v) => v, ofTruth = (v) => v} = {}) {
  let sum = 0;
  let squares = 0;
  let most = 0;
  const count = truth.width * truth.height;
  for (let texel = 0; texel < count; texel += 1) {
    for (const [one, other] of channels) {
      const off = Math.abs(ofRead(read.data[texel * read.channels + one]) - ofTruth(truth.data[texel * truth.channels + other]));
      sum += off;
      squares += off * off;
      if (!(off <= most)) most = off;
    }
  }
  const n = count * channels.length;
  return {mean: sum / n, most, psnr_db: 10 * Math.log10(n / squares)};
}

/** Unit normals, three floats a texel, from texels n / 2 + 1/2; `rebuildZ` where a file has x and y only. */
export function normalsOf(pixels, {greenSign = 1, rebuildZ = false, channels = [0, 1, 2], stored = false} = {}) {
  const out = new Float32Array(pixels.width * pixels.height * 3);
  const decode = stored ? (value) => value : (value) => 2 * value - 1;
  for (let texel = 0; texel < pixels.width * pixels.height; texel += 1) {
    const from = texel * pixels.channels;
    const x = decode(pixels.data[from + channels[0]]);
    const y = greenSign * decode(pixels.data[from + channels[1]]);
    const z = rebuildZ ? Math.sqrt(Math.max(0, 1 - x * x - y * y)) : decode(pixels.data[from + channels[2]]);
    const length = Math.hypot(x, y, z);
    out.set([x / length, y / length, z / length], texel * 3);
  }
  return {width: pixels.width, height: pixels.height, channels: 3, data: out};
}

/** Degrees between normals where those of truth are tilted by less than `tilt_deg`. */
export function angles(read, truth, tilt_deg = 40) {
  const levelest = Math.cos((tilt_deg * Math.PI) / 180);
  const found = [];
  for (let at = 0; at < truth.data.length; at += 3) {
    if (!(truth.data[at + 2] > levelest)) continue;
    const chord = Math.hypot(read.data[at] - truth.data[at], read.data[at + 1] - truth.data[at + 1], read.data[at + 2] - truth.data[at + 2]);
    found.push((2 * Math.asin(Math.min(1, chord / 2)) * 180) / Math.PI);
  }
  const sorted = Float64Array.from(found).sort();
  const sum = sorted.reduce((total, value) => total + value, 0);
  return {mean: sum / sorted.length, p95: sorted[Math.floor(0.95 * (sorted.length - 1))], most: sorted[sorted.length - 1], count: sorted.length};
}
