// SPDX-License-Identifier: Apache-2.0
// What is looked at and how: all of it stands in the address, so that it can be shared and survives a reload.
import type {Vector} from '../../gl/scene';
import type {Repeat} from '../../gl/tiles';
import type {Box, Point, View} from '../../gl/view';

/** A solve of a session; 'truth' stands for the id of a simulated session's own. */
export interface SolveName {
  session: string;
  solve: string;
  /** It is the id of a set of maps that was made of a solve. */
  isSet?: true;
}

export const VIEWER_PANELS = ['look', 'pixel', 'measure', 'compare', 'why', 'finish'] as const;
export type ViewerPanel = (typeof VIEWER_PANELS)[number];

export interface Sight {
  layer: string;
  /** Null: the whole map, as large as the window lets it be. */
  view: View | null;
  light: Vector;
  exposure: number;
  /** Ends of the scale of colours; null: as the values ask for. */
  range: [number, number] | null;
  /** Status bits over the picture; null: those of the layer by itself. */
  bits: readonly string[] | null;
  /** What it is compared with. */
  other: SolveName | null;
  /** Share of the width where the other begins; null: it is not shown. */
  divider: number | null;
  repeat: Repeat;
  /** Whether the borders of maps that are repeated are drawn. */
  seam: boolean;
  /** A pixel that is held, so that its table stays. */
  pixel: Point | null;
  line: [Point, Point] | null;
  box: Box | null;
  /** What stands beside the picture. */
  panel: ViewerPanel;
}

const upperLeft: Vector = [-0.5, 0.5, Math.SQRT1_2];

export const FIRST_SIGHT: Sight = {
  layer: 'relit',
  view: null,
  light: upperLeft,
  exposure: 0,
  range: null,
  bits: null,
  other: null,
  divider: null,
  repeat: 1,
  seam: true,
  pixel: null,
  line: null,
  box: null,
  panel: 'look',
};

function numbersIn(text: string | null, count: number): number[] | null {
  const numbers = (text ?? '').split(',').map(Number);
  return text !== null && numbers.length === count && numbers.every(Number.isFinite) ? numbers : null;
}

function unit(vector: number[]): Vector | null {
  const [x = 0, y = 0, z = 0] = vector;
  const length = Math.hypot(x, y, z);
  return length > 0 ? [x / length, y / length, z / length] : null;
}

export function solveNameOf(text: string | null): SolveName | null {
  return nameOf((text ?? '').split('/'));
}

/** ['satin', 'd043ba17'] a solve, ['satin', 'maps', '1c0f'] a set of maps. */
export function nameOf([session, solve, id, ...rest]: readonly string[]): SolveName | null {
  if (!session || !solve || rest.length > 0) return null;
  if (id === undefined) return {session, solve};
  return solve === 'maps' && id ? {session, solve: id, isSet: true} : null;
}

export function textOf(name: SolveName): string {
  return wordsOf(name).join('/');
}

function wordsOf({session, solve, isSet}: SolveName): string[] {
  return isSet ? [session, 'maps', solve] : [session, solve];
}

/** What a query says; what it does not say, or says wrongly, is as at first sight. */
export function sightOf(query: URLSearchParams): Sight {
  const view = numbersIn(query.get('view'), 3);
  const light = numbersIn(query.get('light'), 3);
  const range = numbersIn(query.get('range'), 2);
  const exposure = numbersIn(query.get('exposure'), 1)?.[0];
  const divider = numbersIn(query.get('divider'), 1)?.[0];
  const pixel = numbersIn(query.get('pixel'), 2);
  const line = numbersIn(query.get('line'), 4);
  const box = numbersIn(query.get('box'), 4);
  const bits = query.get('bits');
  return {
    layer: query.get('layer') ?? FIRST_SIGHT.layer,
    view: view && view[2]! > 0 ? {x: view[0]!, y: view[1]!, zoom: view[2]!} : null,
    light: (light && unit(light)) ?? FIRST_SIGHT.light,
    exposure: exposure ?? 0,
    range: range && range[1]! > range[0]! ? [range[0]!, range[1]!] : null,
    bits: bits === null ? null : bits.split(',').filter((bit) => bit !== ''),
    other: solveNameOf(query.get('with')),
    divider: divider === undefined ? null : Math.min(Math.max(divider, 0), 1),
    repeat: ([2, 3] as const).find((count) => String(count) === query.get('repeat')) ?? 1,
    seam: query.get('seam') !== '0',
    pixel: pixel && {x: pixel[0]!, y: pixel[1]!},
    line: line && [{x: line[0]!, y: line[1]!}, {x: line[2]!, y: line[3]!}],
    box: box && {x: box[0]!, y: box[1]!, width: box[2]!, height: box[3]!},
    panel: VIEWER_PANELS.find((panel) => panel === query.get('panel')) ?? FIRST_SIGHT.panel,
  };
}

/** Four decimals are a tenth of a pixel of a screen at the largest zoom, and a hundredth of a degree of a light. */
function written(numbers: readonly number[]): string {
  return numbers.map((number) => String(Number(number.toFixed(4)))).join(',');
}

function unlessFirst(text: string, first: string): string | null {
  return text === first ? null : text;
}

/** The words of the query that say a sight. Null: not needed. */
export function queryOf(sight: Sight): Record<string, string | null> {
  const {view, range, pixel, line, box} = sight;
  return {
    layer: unlessFirst(sight.layer, FIRST_SIGHT.layer),
    view: view && `${written([view.x, view.y])},${Number(view.zoom.toPrecision(8))}`,
    light: unlessFirst(written(sight.light), written(FIRST_SIGHT.light)),
    exposure: unlessFirst(written([sight.exposure]), '0'),
    range: range && written(range),
    bits: sight.bits && sight.bits.join(','),
    with: sight.other && textOf(sight.other),
    divider: sight.divider === null ? null : written([sight.divider]),
    repeat: unlessFirst(String(sight.repeat), '1'),
    seam: sight.seam ? null : '0',
    pixel: pixel && written([pixel.x, pixel.y]),
    line: line && written(line.flatMap(({x, y}) => [x, y])),
    box: box && written([box.x, box.y, box.width, box.height]),
    panel: unlessFirst(sight.panel, FIRST_SIGHT.panel),
  };
}

function searchOf(sight: Sight): URLSearchParams {
  const query = new URLSearchParams();
  for (const [name, word] of Object.entries(queryOf(sight))) {
    if (word !== null) query.set(name, word);
  }
  return query;
}

/** A sight as the address keeps it, so that whoever opens the address sees the same to the last pixel. */
export function asWritten(sight: Sight): Sight {
  return sightOf(searchOf(sight));
}

/** Where a solve is looked at; with a sight, also how. */
export function addressOfViewer(name: SolveName, sight = FIRST_SIGHT): string {
  const search = searchOf(sight).toString();
  return `/viewer/${wordsOf(name).map(encodeURIComponent).join('/')}${search && `?${search}`}`;
}
