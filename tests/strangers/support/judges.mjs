// SPDX-License-Identifier: Apache-2.0
// What read texels must be, given the maps that they were made of.
import {angles, difference, normalsOf, sameSize, srgbOfLinear} from './compare.mjs';
import {below} from './report.mjs';

/** A whole number is off by half a step at most and what 32-bit floats round before; a half float by half of its last place. */
export function halfStep({bits, whole}) {
  if (whole) return 0.5 / (2 ** bits - 1) + 2e-7;
  return bits === 16 ? 2 ** -11 : 1e-6;
}

/** Degrees of the mean below 40 degrees of tilt, by the bits of the file. */
export function judgeNormals(texels, truth, {greenSign = 1, rebuildZ = false, stored = false, channels = [0, 1, 2], limit = texels.bits === 8 ? 0.2 : 0.01} = {}) {
  const size = sameSize(texels, truth);
  if (!size.ok) return size;
  const {mean, most} = angles(normalsOf(texels, {greenSign, rebuildZ, stored, channels}), truth);
  return below(mean, limit, ' deg', `, most ${most.toFixed(2)}, tilt below 40 deg`);
}

/** Albedo in sRGB, or linear: within half a step of what is written. */
export function judgeAlbedo(texels, truth, {srgb = true, limit = halfStep(texels)} = {}) {
  const size = sameSize(texels, truth);
  if (!size.ok) return size;
  const held = texels.whole ? (value) => Math.min(Math.max(value, 0), 1) : (value) => value;
  const channels = [0, 1, 2].map((channel) => [Math.min(channel, texels.channels - 1), channel]);
  return below(difference(texels, truth, channels, {ofTruth: srgb ? srgbOfLinear : held}).most, limit, '', ` at most, ${srgb ? 'sRGB' : 'linear'}`);
}

/** One channel of texels against one of a map: value = offset + scale * texel. */
export function judgePlane(texels, truth, {channel = 0, ofTruth = 0, scale = 1, offset = 0, limit = halfStep(texels) * Math.abs(scale)} = {}) {
  const size = sameSize(texels, truth);
  if (!size.ok) return size;
  return below(difference(texels, truth, [[channel, ofTruth]], {ofRead: (texel) => offset + scale * texel}).most, limit, '', ' at most');
}
