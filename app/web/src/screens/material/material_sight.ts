// SPDX-License-Identifier: Apache-2.0
// Which material is looked at and how: all of it stands in the address.
import type {Vector} from '../../gl/scene';
import type {Numbers} from './parameters';

/** A set of maps of a session, or what was built of a material. */
export interface MaterialName {
  of: string;
  is: 'maps' | 'builds';
  id: string;
}

export const SHAPES = ['ball', 'plane', 'true'] as const;
export type Shape = (typeof SHAPES)[number];
export const MATERIAL_PANELS = ['look', 'layers', 'export'] as const;
export type MaterialPanel = (typeof MATERIAL_PANELS)[number];
export const REPEATS = [1, 2, 3] as const;
export const BALLS_MM = [20, 50, 150] as const;

export interface MaterialSight {
  shape: Shape;
  /** Pieces a side of the plane. */
  repeat: (typeof REPEATS)[number];
  /** Diameter of the ball where its maps repeat. */
  ball_mm: number;
  /** How far the plane leans back. */
  lean_deg: number;
  light: Vector;
  exposure: number;
  surroundings: number;
  /** In place of what is assumed. */
  typed: Numbers;
  panel: MaterialPanel;
}

export const FIRST: MaterialSight = {
  shape: 'ball', repeat: 1, ball_mm: 50, lean_deg: 0, light: [-0.5, 0.5, Math.SQRT1_2], exposure: 0, surroundings: 0.2, typed: {}, panel: 'look',
};
export const MOST_LEAN_DEG = 75;
const TYPED = ['roughness', 'f0', 'sheen', 'sheen_roughness'];

/** ['satin', 'maps', '1c0f']; null: there is nothing of this name. */
export function nameOf([of, is, id, ...rest]: readonly string[]): MaterialName | null {
  return of && id && rest.length === 0 && (is === 'maps' || is === 'builds') ? {of, is, id} : null;
}

/** Where its maps are asked for. */
export function addressOfMaterial({of, is, id}: MaterialName): string {
  return `/api/v1/${is === 'maps' ? 'sessions' : 'materials'}/${encodeURIComponent(of)}/${is}/${encodeURIComponent(id)}`;
}

/** Where it is looked at. */
export function placeOfMaterial({of, is, id}: MaterialName, panel: MaterialPanel = FIRST.panel): string {
  return `/material/${[of, is, id].map(encodeURIComponent).join('/')}${panel === FIRST.panel ? '' : `?panel=${panel}`}`;
}

function numberIn(query: URLSearchParams, name: string, least: number, most: number): number | null {
  const text = query.get(name);
  const number = Number(text);
  return text !== null && text.trim() !== '' && Number.isFinite(number) ? Math.min(Math.max(number, least), most) : null;
}

function lightIn(text: string | null): Vector | null {
  const [x = NaN, y = NaN, z = NaN] = (text ?? '').split(',').map(Number);
  const length = Math.hypot(x, y, z);
  return length > 0 && z > 0 ? [x / length, y / length, z / length] : null;
}

/** What a query says; what it does not say, or says wrongly, is as at first. */
export function sightOf(query: URLSearchParams): MaterialSight {
  const typed: Record<string, number> = {};
  for (const name of TYPED) {
    const number = numberIn(query, name, 0, 1);
    if (number !== null) typed[name] = number;
  }
  return {
    shape: SHAPES.find((shape) => shape === query.get('shape')) ?? FIRST.shape,
    repeat: REPEATS.find((count) => String(count) === query.get('repeat')) ?? FIRST.repeat,
    ball_mm: numberIn(query, 'ball', 1, 1000) ?? FIRST.ball_mm,
    lean_deg: numberIn(query, 'lean', 0, MOST_LEAN_DEG) ?? FIRST.lean_deg,
    light: lightIn(query.get('light')) ?? FIRST.light,
    exposure: numberIn(query, 'exposure', -4, 6) ?? FIRST.exposure,
    surroundings: numberIn(query, 'surroundings', 0, 1) ?? FIRST.surroundings,
    typed,
    panel: MATERIAL_PANELS.find((panel) => panel === query.get('panel')) ?? FIRST.panel,
  };
}

function written(numbers: readonly number[]): string {
  return numbers.map((number) => String(Number(number.toFixed(4)))).join(',');
}

/** The words of the query. Null: not needed. */
export function queryOf(sight: MaterialSight): Record<string, string | null> {
  const {ball_mm, lean_deg, light, exposure, surroundings, typed} = sight;
  const words: Record<string, [string, string]> = {
    shape: [sight.shape, FIRST.shape],
    repeat: [String(sight.repeat), String(FIRST.repeat)],
    ball: [written([ball_mm]), written([FIRST.ball_mm])],
    lean: [written([lean_deg]), written([FIRST.lean_deg])],
    light: [written(light), written(FIRST.light)],
    exposure: [written([exposure]), written([FIRST.exposure])],
    surroundings: [written([surroundings]), written([FIRST.surroundings])],
    panel: [sight.panel, FIRST.panel],
  };
  const query: Record<string, string | null> = {};
  for (const [name, [word, first]] of Object.entries(words)) query[name] = word === first ? null : word;
  for (const name of TYPED) query[name] = typed[name] === undefined ? null : written([typed[name]]);
  return query;
}
