// SPDX-License-Identifier: Apache-2.0
// Pictures as {width, height, channels, bits, whole, names, data}: data are floats, interleaved, top row first, from
// 0 to 1 where the file has whole numbers.
import fs from 'node:fs';
import path from 'node:path';
import {PNG} from 'pngjs';
import {here, python, run} from './programs.mjs';

/** What reader ("pillow", "openimageio") takes each file for; a file that it refuses is {error}. */
export function readPixels(reader, files) {
  const {code, out, err} = run(python, [path.join(here, 'support/pixels.py'), reader, ...files], {binary: true});
  if (code !== 0) throw new Error(`${reader}: ${err}`);
  let at = 0;
  return files.map(() => {
    const end = out.indexOf(10, at);
    const facts = JSON.parse(out.subarray(at, end).toString());
    at = end + 1;
    if (facts.error) return facts;
    const bytes = 4 * facts.width * facts.height * facts.channels;
    facts.data = new Float32Array(out.buffer.slice(out.byteOffset + at, out.byteOffset + at + bytes));
    at += bytes;
    return facts;
  });
}

/** By pngjs, which keeps 16 bits. */
export function readPng(bytes) {
  const png = PNG.sync.read(bytes, {skipRescale: true});
  const most = png.depth === 16 ? 65535 : 255;
  const whole = png.data.length === png.width * png.height * 4 ? png.data : new Uint16Array(png.data.buffer, png.data.byteOffset, png.width * png.height * 4);
  return {width: png.width, height: png.height, channels: 4, bits: png.depth, whole: true, names: [...'rgba'], data: Float32Array.from(whole, (value) => value / most)};
}

export function readPngFile(file) {
  return readPng(fs.readFileSync(file));
}

/** A PNG of 8 or 16 bits, red, green and blue. */
export function writePng({width, height, channels, bits, data}) {
  const most = bits === 16 ? 65535 : 255;
  const out = bits === 16 ? new Uint16Array(width * height * 4).fill(65535) : new Uint8Array(width * height * 4).fill(255);
  for (let texel = 0; texel < width * height; texel += 1) {
    for (let channel = 0; channel < 3; channel += 1) out[4 * texel + channel] = Math.round(data[channels * texel + Math.min(channel, channels - 1)] * most);
  }
  const png = new PNG({width, height, bitDepth: bits});
  png.data = Buffer.from(out.buffer);
  return PNG.sync.write(png, {bitDepth: bits, colorType: 2, inputColorType: 6, inputHasAlpha: true});
}

/** The twin of a normal map whose second channel points the other way. */
export function greenFlipped(pixels) {
  const data = Float32Array.from(pixels.data);
  for (let at = 1; at < data.length; at += pixels.channels) data[at] = 1 - data[at];
  return {...pixels, data};
}
