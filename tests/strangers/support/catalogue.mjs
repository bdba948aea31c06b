// SPDX-License-Identifier: Apache-2.0
// What a texel of an exported file must hold, computed from the maps by the words of docs/reference/exports.md and
// apart from the program that wrote it.
import fs from 'node:fs';
import path from 'node:path';
import {srgbOfLinear} from './compare.mjs';
import {readPixels} from './pixels.mjs';

/** A folder of maps: {width, height, mm_per_pixel, size_mm, plane(map, channel) -> function of a texel or null}. */
export class Maps {
  constructor(folder) {
    this.kind = fs.existsSync(path.join(folder, 'maps.json')) ? 'maps' : 'material';
    this.file = path.join(folder, `${this.kind}.json`);
    this.facts = JSON.parse(fs.readFileSync(this.file, 'utf8'));
    this.maps = new Map(this.facts.maps.map((map) => [map.name, map]));
    // Solved maps lie beside the derived ones that the document lists.
    const fileOf = (name) => path.join(folder, this.maps.get(name)?.file ?? `${name}.exr`);
    const names = wanted.filter((name) => fileOf(name).endsWith('.exr') && fs.existsSync(fileOf(name)));
    const read = readPixels('openimageio', names.map(fileOf));
    this.pixels = new Map(names.map((name, at) => [name, read[at]]).filter(([, pixels]) => pixels.width === this.facts.width));
    this.width = this.facts.width;
    this.height = this.facts.height;
    const mm = this.facts.mm_per_pixel;
    this.mm_per_pixel = typeof mm === 'number' ? mm : null;
    this.size_mm = this.mm_per_pixel ? [this.width * mm, this.height * mm] : null;
  }

  pixelsOf(map, names) {
    const pixels = this.pixels.get(map);
    if (!pixels) return null;
    return names.every((name) => pixels.names.includes(name)) ? pixels : null;
  }

  plane(map, channel) {
    const pixels = this.pixelsOf(map, [channel]);
    if (pixels) {
      const at = pixels.names.indexOf(channel);
      return (texel) => pixels.data[texel * pixels.channels + at];
    }
    const constant = this.maps.get(map)?.constant ?? this.facts.parameters?.[map]?.value ?? otherwise[map];
    return typeof constant === 'number' ? () => constant : null;
  }
}

const wanted = ['albedo', 'normal', 'height', 'occlusion', 'opacity', 'roughness', 'specular', 'cavity', 'metallic', 'sheen', 'sheen_roughness', 'cloth'];
const otherwise = {opacity: 1, metallic: 0};

const conventions = {
  alpha: (alpha) => alpha,
  root: (alpha) => Math.sqrt(alpha),
  smoothness: (alpha) => 1 - Math.sqrt(alpha),
};

function roughnessOf(maps, convention, join) {
  const across = maps.plane('roughness', 'alpha');
  const along = maps.plane('roughness', 'alpha_along') ?? across;
  const said = conventions[convention];
  return across && said ? (texel) => said(join(across(texel), along(texel))) : null;
}

/** The value of a channel as a function of the texel, or null where this table does not know it. */
function valueOf(name, maps, entry) {
  const [map, part] = name.split('.');
  const sign = entry.direction === 'directx' ? -1 : 1;
  if (map === 'albedo' && 'rgb'.includes(part)) return maps.plane('albedo', part.toUpperCase());
  if (map === 'sheen' && 'rgb'.includes(part)) return maps.plane('sheen', part.toUpperCase());
  if (name === 'normal.y') {
    const y = maps.plane('normal', 'Y');
    return y && ((texel) => sign * y(texel));
  }
  if (map === 'normal') return maps.plane('normal', part.toUpperCase());
  if (name === 'roughness') return roughnessOf(maps, entry.roughness, (a, b) => Math.sqrt(a * b));
  if (name === 'roughness.least') return roughnessOf(maps, entry.roughness, Math.min);
  if (name === 'specular' || name === 'f0') {
    const f0 = maps.plane('specular', 'f0');
    return f0 && ((texel) => f0(texel) / (name === 'f0' ? 1 : 0.08));
  }
  const constants = {zero: 0, half: 0.5, one: 1};
  if (name in constants) return () => constants[name];
  const single = {height: 'height', occlusion: 'openness', opacity: 'opacity', cavity: 'cavity', metallic: 'metallic', sheen_roughness: 'sheen_roughness', cloth: 'cloth'};
  return name in single ? maps.plane(name, single[name]) : null;
}

const isColor = (name) => /^(albedo|sheen|specular_tint)\./.test(name);
export const isNormal = (name) => /^(detail\.)?normal\./.test(name) || /^anisotropy\./.test(name);

/** Samples as the file holds them: of a channel a function of the texel, or null. */
export function sampleOf(at, maps, entry) {
  const name = entry.channels[at];
  const value = valueOf(name, maps, entry);
  if (!value) return null;
  const isFloat = ['exr', 'tx'].includes(entry.encoding);
  if (isFloat) return value;
  const [least, most] = entry.ranges[at] ?? (isNormal(name) ? [-1, 1] : [0, 1]);
  const held = (texel) => (most > least ? Math.min(Math.max((value(texel) - least) / (most - least), 0), 1) : 0.5);
  return isColor(name) && entry.color === 'srgb' ? (texel) => srgbOfLinear(held(texel)) : held;
}
