// SPDX-License-Identifier: Apache-2.0
// A set of photographs as people read it: each one answered, what the frame was covered by, what is known by now.
import type {Schemas} from '../../api/client';
import {counted} from '../../ui/say';
import {fieldsOf, isFields, listIn, numberIn, textIn} from '../../ui/fields';

export type PhotographSet = Schemas['PhotographSet'];
export type Photograph = PhotographSet['photographs'][number];

export interface Coverage {
  columns: number;
  rows: number;
  /** Corners seen in each part of the picture, row by row. */
  corners: number[];
  seen: number;
  /** Where its corners were seen less where they are predicted, pixels, row by row; empty: not known yet. */
  residuals: XY[];
}

/** One figure of how well something is known. */
export interface CameraFigure {
  key: string;
  name: string;
  unit: string;
  now: number;
  asked: number;
  /** With the next photograph; null: it is not said. */
  then: number | null;
}

const figures = [
  {key: 'focal_percent', name: 'Focal length', unit: '%'},
  {key: 'place_mm', name: 'Place on the table', unit: 'mm'},
];

export function coverageOf(set: PhotographSet): Coverage | null {
  const coverage = fieldsOf(set.figures)['coverage'];
  const columns = numberIn(coverage, 'columns');
  const rows = numberIn(coverage, 'rows');
  if (columns === null || rows === null) return null;
  const corners = listIn(coverage, 'corners').filter((each) => typeof each === 'number');
  return {columns, rows, corners, seen: numberIn(coverage, 'seen') ?? 0, residuals: pointsIn(fieldsOf(coverage)['residual_px'])};
}

/** How many pixels an arrow as long as a part of the picture is wide stands for: the longest has half of it. */
export function arrowScale(residuals: readonly XY[]): number {
  const longest = Math.max(...residuals.map(([x, y]) => Math.hypot(x, y)));
  const decade = 10 ** Math.floor(Math.log10(2 * longest));
  return decade * ([1, 2, 5].find((step) => step * decade >= 2 * longest) ?? 10);
}

export function figuresOf(set: PhotographSet): CameraFigure[] {
  const {predicted, asked, then} = fieldsOf(set.figures);
  return figures.flatMap((figure) => {
    const now = numberIn(predicted, figure.key);
    const wanted = numberIn(asked, figure.key);
    if (now === null || wanted === null) return [];
    return [{...figure, now, asked: wanted, then: isFields(then) ? numberIn(then, figure.key) : null}];
  });
}

/** How far it is on the way to what is asked, by a logarithm: from ten times as much to it. */
export function shareOf(figure: CameraFigure): number {
  return Math.max(0, Math.min(1, 1 - Math.log10(figure.now / figure.asked)));
}

export function isMet(figure: CameraFigure): boolean {
  return figure.now <= figure.asked;
}

/** What is known of a photograph that counts. */
export function factsOf(photograph: Photograph): string[] {
  const facts = fieldsOf(photograph.facts);
  const number = (key: string, say: (value: number) => string) => {
    const value = numberIn(facts, key);
    return value === null ? [] : [say(value)];
  };
  return [
    ...number('corners', (n) => counted(n, 'corner')),
    ...number('tags', (n) => counted(n, 'tag')),
    ...number('tilt_deg', (n) => (n < 0.5 ? 'flat' : `tilted by ${Math.round(n)}°`)),
    ...number('photographs', (n) => counted(n, 'photograph')),
    ...[textIn(facts, 'note')].filter((note) => note !== ''),
  ];
}

/** How many photographs a series needs that is taken at once; null: it is one photograph. */
export function wantedOf(photograph: Photograph): number | null {
  return numberIn(photograph.facts, 'wanted');
}

/** How far corners are from where they should be, pixels rms; null where there is nothing to measure by. */
export function residualOf(photograph: Photograph): number | null {
  return numberIn(photograph.facts, 'rms_px') ?? numberIn(photograph.facts, 'residual_px');
}

export function largestResidual(set: PhotographSet): number {
  return Math.max(0, ...set.photographs.map((each) => residualOf(each) ?? 0));
}

/** What became of the step of this name, once it was photographed. */
export function takenBy(set: PhotographSet, step: string): Photograph | null {
  return set.photographs.find(({name}) => name === step || name.startsWith(`${step}.`)) ?? null;
}

/** The photograph that `undo` leaves out: the last that counts. */
export function lastUsed(set: PhotographSet): Photograph | null {
  return set.photographs.filter((each) => each.used).at(-1) ?? null;
}

export type XY = readonly [number, number];

/** The outline of the pose that is wanted, in shares of the picture; null: there is none, or its place is not said. */
export function outlineWanted(set: PhotographSet): XY[] | null {
  const outline = pointsIn(fieldsOf(set.next?.pose)['outline']);
  return outline.length > 2 ? outline : null;
}

/** Where the newest photograph has the thing that was looked for; null: it is not said. */
export function outlineFound(set: PhotographSet): XY[] | null {
  const outline = pointsIn(fieldsOf(set.photographs.filter((each) => !each.left_out).at(-1)?.facts)['outline']);
  return outline.length > 2 ? outline : null;
}

export function pointsIn(list: unknown): XY[] {
  if (!Array.isArray(list)) return [];
  return list.flatMap((each: unknown) => {
    const [x, y] = Array.isArray(each) ? (each as unknown[]) : [];
    return typeof x === 'number' && typeof y === 'number' ? [[x, y] as const] : [];
  });
}
