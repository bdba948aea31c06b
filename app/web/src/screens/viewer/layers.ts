// SPDX-License-Identifier: Apache-2.0
// Layers as people choose them, their scales of colour, and the bits of status with their colours.
import type {Schemas} from '../../api/client';
import type {Rgb} from '../../gl/heat';
import type {Mode} from '../../gl/shaders';

export type ViewedSolve = Schemas['ViewedSolve'];

export interface LayerChoice {
  name: string;
  says: string;
  key: string;
}

/** In the order of their keys. */
export const LAYERS: readonly LayerChoice[] = [
  {name: 'albedo', says: 'Albedo', key: '1'},
  {name: 'normal', says: 'Normals', key: '2'},
  {name: 'relit', says: 'Relit', key: '3'},
  {name: 'sigma', says: 'Sigma', key: '4'},
  {name: 'residual', says: 'Residual', key: '5'},
  {name: 'status', says: 'Status', key: '6'},
  {name: 'height', says: 'Height', key: '7'},
  {name: 'condition', says: 'Condition', key: '8'},
  {name: 'roughness', says: 'Roughness', key: '9'},
];
/** Layers that take two solves. */
export const DIFFERENCES: readonly LayerChoice[] = [
  {name: 'difference', says: 'Difference', key: 'd'},
  {name: 'albedo_difference', says: 'Albedo difference', key: 'a'},
];

/** Parts of sigma, which the daemon has as layers of their own. */
export const SIGMA_PARTS: readonly {name: string; says: string}[] = [
  {name: 'sigma', says: 'all of it'},
  {name: 'sigma_noise', says: 'noise'},
  {name: 'sigma_model', says: 'cloth unlike the model'},
  {name: 'sigma_calibration', says: 'calibration'},
];

const explanations: Record<string, string> = {
  albedo: 'Share of light that the cloth sends back, without shade.',
  normal: 'Which way the cloth faces: red right, green up, blue to the camera.',
  relit: 'Albedo and normals under one distant light. Attached shadows do not average: from afar a light below 25 degrees is up to 10 % too dark.',
  sigma: 'Predicted error of the normal.',
  sigma_noise: 'Predicted error of the normal: photon and read noise.',
  sigma_model: 'Predicted error of the normal: what the cloth does that the model does not.',
  sigma_calibration: 'Predicted error of the normal: where lights and camera are.',
  residual: 'What the readings miss of the model, as a share of the albedo.',
  status: 'What was left out in a pixel, and what is to be known of it.',
  height: 'Height of the cloth.',
  condition: 'How much larger the lights that a pixel was solved from may make errors, in decades: at 3 a thousand times. At 16 they do not span three directions.',
  roughness: 'Root of alpha, as games have it. 1 where no lobe was measured.',
  occlusion: 'Share of the sky that a place sees.',
  bent_normal: 'Mean direction to the sky that a place sees.',
  cavity: 'How far a place lies below what is around it.',
  curl: 'What no height has: slopes that do not come back to where they began.',
  opacity: 'Share of light that the cloth stops.',
  difference: 'Angle between the normals of the two.',
  albedo_difference: 'By how much the albedo is off, in percent of the other: mean of red, green and blue.',
};

export function explanationOf(layer: string): string {
  return explanations[layer] ?? '';
}

export function saysOf(layer: string): string {
  const part = SIGMA_PARTS.find(({name}) => name === layer && name !== 'sigma');
  if (part) return `Sigma: ${part.says}`;
  return [...LAYERS, ...DIFFERENCES].find(({name}) => name === layer)?.says ?? inWords(layer);
}

/** "bent_normal": "Bent normal" */
function inWords(name: string): string {
  return name.charAt(0).toUpperCase() + name.slice(1).replaceAll('_', ' ');
}

export function isDifference(layer: string): boolean {
  return DIFFERENCES.some(({name}) => name === layer);
}

export function modeOf(solve: ViewedSolve, layer: string): Mode {
  if (layer === 'relit') return layer;
  return solve.layers.find(({name}) => name === layer)?.kind ?? 'scalar';
}

export function hasScale(solve: ViewedSolve, layer: string): boolean {
  return modeOf(solve, layer) === 'scalar';
}

/** Scales that begin at 0; others begin where most values do. */
export function beginsAtZero(layer: string): boolean {
  return /^sigma|^residual|^roughness/.test(layer);
}

/** Layers as they are chosen from: those with a key, then what else a set of maps has. */
export function choicesOf(solve: ViewedSolve): LayerChoice[] {
  const known = LAYERS.filter(({name}) => isThere(solve, name));
  const others = solve.layers.filter(({name}) => !known.some((each) => each.name === name) && !name.startsWith('sigma'));
  return [...known, ...others.map(({name}) => ({name, says: saysOf(name), key: ''}))];
}

export function hasExposure(layer: string): boolean {
  return layer === 'albedo' || layer === 'relit';
}

/** Whether these maps can be seen so. */
export function isThere(solve: ViewedSolve, layer: string): boolean {
  const has = (name: string) => solve.layers.some((each) => each.name === name);
  if (layer === 'relit') return has('albedo') && has('normal');
  if (isDifference(layer)) return has('normal') && has('albedo');
  return has(layer);
}

/** "deg", "mm", "share" in the words of a scale. */
export function unitOf(solve: ViewedSolve, layer: string): string {
  if (layer === 'albedo_difference') return '%';
  const unit = layer === 'difference' ? 'deg' : (solve.layers.find(({name}) => name === layer)?.unit ?? '');
  if (unit === 'deg') return '°';
  if (unit === 'share') return layer === 'residual' ? 'of the albedo' : '';
  return unit;
}

/** Upper ends of scales that are offered. */
export const FULL_SCALES: readonly number[] = [0.1, 0.3, 1, 3, 10];

/** What most values fill: the least of 0.01, 0.03, 0.1 ... that is above them. */
export function fullScale(value: number): number {
  const scales = [0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30, 90];
  return scales.find((scale) => scale >= value) ?? 180;
}

/** The bits, in colours that can be told apart without red and green. */
const colours: Record<string, Rgb> = {
  SATURATED: [1, 0.85, 0.1],
  SHADOWED: [0.25, 0.5, 1],
  ZERO_DOF: [0.6, 0.6, 0.6],
  DARK: [0.45, 0.3, 0.75],
  ILL_CONDITIONED: [0.95, 0.5, 0.05],
  NO_SOLUTION: [1, 0.1, 0.55],
  SPECULAR: [0.3, 0.9, 1],
  INVALID_READING: [1, 1, 1],
  GLOSSY: [0.2, 0.7, 0.45],
  YARN_ACROSS: [0.9, 0.6, 0.8],
  SECOND_LOBE: [0.55, 0.65, 0.1],
};

const meanings: Record<string, string> = {
  SATURATED: 'a reading was left out as too bright',
  SHADOWED: 'a reading was left out as shadowed',
  ZERO_DOF: 'three readings, none to test them by',
  DARK: 'no reading stands out of the noise',
  ILL_CONDITIONED: 'the lights come from too nearly one side',
  NO_SOLUTION: 'too few readings: the normal is a guess',
  SPECULAR: 'a reading far above what matt cloth sends',
  INVALID_READING: 'a reading is missing or not to be believed',
  GLOSSY: 'solved with the lobe of its cloth',
  YARN_ACROSS: 'its yarn lies across the lobe',
  SECOND_LOBE: 'of the second of two materials',
};

export function bitColour(bit: string): Rgb {
  return colours[bit] ?? [0.8, 0.8, 0.8];
}

export function bitMeaning(bit: string): string {
  return meanings[bit] ?? '';
}

export function bitsOf(solve: ViewedSolve): readonly string[] {
  return solve.layers.find(({kind}) => kind === 'flags')?.bits ?? [];
}
