// SPDX-License-Identifier: Apache-2.0
// What a material is made of: each parameter with where it comes from, by a maps.json or a material.json.
import type {ClothLayer, Four} from '../../gl/cloth_surface';
import {fieldsOf, listIn, numberIn, textIn} from '../../ui/fields';

export type Source = 'measured' | 'derived' | 'assumed';

export interface Parameter {
  name: string;
  says: string;
  source: Source;
  /** What the document says of it: why it is a number, what was typed. */
  why: string;
  unit: string;
  /** A map has its mean here. Null: not known. */
  value: number | null;
  /** Red, green and blue of what is the same everywhere. */
  rgb: [number, number, number] | null;
  isMap: boolean;
  /** Ends of its slider: what is assumed may be tried otherwise. */
  ends: readonly [number, number] | null;
}

interface Kind {
  name: string;
  says: string;
  /** What it is where nobody says: null, then it is not listed. */
  otherwise: number | null;
  ends?: readonly [number, number];
}

const kinds: readonly Kind[] = [
  {name: 'albedo', says: 'Albedo', otherwise: null},
  {name: 'normal', says: 'Normal', otherwise: null},
  {name: 'height', says: 'Height', otherwise: null},
  {name: 'roughness', says: 'Roughness', otherwise: 0.7, ends: [0.05, 1]},
  {name: 'f0', says: 'Reflectance head-on', otherwise: 0.04, ends: [0, 0.2]},
  {name: 'specular_tint', says: 'Colour of highlights', otherwise: null},
  {name: 'sheen', says: 'Sheen', otherwise: 0, ends: [0, 1]},
  {name: 'sheen_roughness', says: 'Roughness of the sheen', otherwise: 0.5, ends: [0.1, 1]},
  {name: 'occlusion', says: 'Occlusion', otherwise: 1},
  {name: 'opacity', says: 'Opacity', otherwise: 1},
  {name: 'metallic', says: 'Metal', otherwise: null},
];

/** As documents call them. */
const otherNames: Record<string, string> = {f0: 'specular'};

function sourceOf(word: string): Source {
  return word === 'measured' || word === 'derived' ? word : 'assumed';
}

/** The numbers of a parameter: by itself, within its facts, one or three. */
function numbersOf(value: unknown): number[] {
  if (typeof value === 'number') return [value];
  if (Array.isArray(value)) return value.filter((each) => typeof each === 'number');
  const within = fieldsOf(value)['value'] ?? fieldsOf(value)['constant'];
  return within === undefined ? [] : numbersOf(within);
}

function meanOf(numbers: readonly number[]): number | null {
  return numbers.length === 0 ? null : numbers.reduce((sum, each) => sum + each, 0) / numbers.length;
}

/** What a solve left stands beside a maps.json and not in it: `layers` have it. */
const solved = ['albedo', 'normal', 'roughness'];

export function parametersOf(document: unknown, layers: readonly {name: string}[] = []): Parameter[] {
  const listed = listIn(document, 'maps');
  const isSolved = (name: string) => solved.includes(name) && !listed.some((each) => textIn(each, 'name') === name);
  const maps = [...listed, ...layers.filter(({name}) => isSolved(name)).map(({name}) => ({name, file: `${name}.exr`, source: 'measured'}))];
  const numbers = fieldsOf(fieldsOf(document)['parameters']);
  return kinds.flatMap(({name, says, otherwise, ends}): Parameter[] => {
    const names = [name, otherNames[name]];
    const map = maps.find((each) => names.includes(textIn(each, 'name')));
    const number = numbers[name] ?? numbers[otherNames[name] ?? ''];
    const isMap = map !== undefined && textIn(map, 'file') !== '';
    const of = map ?? number;
    if (of === undefined && otherwise === null) return [];
    const source = of === undefined ? 'assumed' : sourceOf(textIn(of, 'source'));
    const numbersOfIt = numbersOf(map ?? number);
    const [r, g = r, b = r] = numbersOfIt;
    return [{
      name, says, source, why: textIn(of, 'why'), unit: textIn(of, 'unit'), isMap,
      value: isMap ? numberIn(map, 'mean') : (meanOf(numbersOfIt) ?? otherwise),
      rgb: isMap || r === undefined ? null : [r, g ?? r, b ?? r],
      ends: !isMap && source === 'assumed' ? (ends ?? null) : null,
    }];
  });
}

/** How the maps that are there are shaded. `layers`: what the daemon can cut tiles of. */
export function layersOf(layers: readonly {name: string}[]): ClothLayer[] {
  const wanted: (ClothLayer & {of?: string})[] = [
    {layer: 'normal', kind: 'normal', target: 'normal'},
    {layer: 'albedo', kind: 'color', target: 'color'},
    {layer: 'occlusion', kind: 'scalar', target: 'scalars', channel: 0},
    {layer: 'roughness', kind: 'scalar', target: 'scalars', channel: 1},
    {layer: 'opacity', kind: 'scalar', target: 'scalars', channel: 2},
    {layer: 'specular', kind: 'scalar', target: 'scalars', channel: 3},
    {layer: 'specular_tint', kind: 'color', target: 'tints'},
    {layer: 'sheen', kind: 'color', target: 'sheens'},
    {layer: 'sheen_roughness', kind: 'scalar', target: 'sheens', channel: 3},
  ];
  return wanted.filter(({layer}) => layers.some(({name}) => name === layer));
}

export type Numbers = Readonly<Record<string, number>>;

/** The numbers of a look: what is typed over what the document says. */
export function shadedBy(parameters: readonly Parameter[], layers: readonly ClothLayer[], typed: Numbers) {
  const value = (name: string) => typed[name] ?? parameters.find((each) => each.name === name && !each.isMap)?.value ?? kinds.find((each) => each.name === name)?.otherwise ?? 0;
  const isMap = (layer: string) => (layers.some((each) => each.layer === layer) ? 1 : 0);
  const rgbOf = (name: string) => (typed[name] === undefined ? parameters.find((each) => each.name === name)?.rgb : null);
  const sheen = rgbOf('sheen') ?? [value('sheen'), value('sheen'), value('sheen')];
  const grey: [number, number, number] = [0.5, 0.5, 0.5], white: [number, number, number] = [1, 1, 1];
  return {
    typed_color: isMap('albedo') ? null : (rgbOf('albedo') ?? grey),
    typed_tint: isMap('specular_tint') ? null : (rgbOf('specular_tint') ?? white),
    typed: [value('occlusion'), value('roughness'), value('opacity'), value('f0')] as Four,
    mapped: [isMap('occlusion'), isMap('roughness'), isMap('opacity'), isMap('specular')] as Four,
    typed_sheen: [...sheen, value('sheen_roughness')] as Four,
    mapped_sheen: [isMap('sheen'), isMap('sheen'), isMap('sheen'), isMap('sheen_roughness')] as Four,
    metallic: value('metallic'),
  };
}
