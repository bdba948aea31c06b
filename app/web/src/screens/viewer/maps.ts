// SPDX-License-Identifier: Apache-2.0
// The maps of a solve as the daemon tells of them, and a side of the picture made of them.
import {fetched} from '../../api/client';
import {addressOf} from '../../api/calls';
import type {Side} from '../../gl/scene';
import {isDifference, isThere, modeOf, type ViewedSolve} from './layers';
import {type SolveName, textOf} from './sight';

export interface Maps {
  name: SolveName;
  solve: ViewedSolve;
}

/** "robust d043ba17" */
export function solveInWords(solve: {method: string; id: string}): string {
  return `${solve.method} ${solve.id.slice(0, 8)}`;
}

export function addressOfMaps(name: SolveName): string {
  const of = name.isSet ? 'maps' : 'solves';
  return `/api/v1/sessions/${encodeURIComponent(name.session)}/${of}/${encodeURIComponent(name.solve)}`;
}

/** Maps of a solve and those of a set are asked the same. */
export async function askOf<T>(name: SolveName, what: '' | '/pixel' | '/region' | '/line', query: Record<string, number> = {}): Promise<T> {
  return (await fetched(addressOf(addressOfMaps(name) + what, {query}))).json() as Promise<T>;
}

export async function loadMaps(name: SolveName): Promise<Maps> {
  return {name, solve: await askOf<ViewedSolve>(name, '')};
}

export function isSameSize(a: Maps, b: Maps): boolean {
  return a.solve.width === b.solve.width && a.solve.height === b.solve.height;
}

/** Whether the albedo of the maps is seen in it. */
function isShaded(layer: string): boolean {
  return ['albedo', 'relit', 'status'].includes(layer);
}

/** These maps shown as a layer, and bits of their status over it. Null where they have no such layer. */
export function sideOf(maps: Maps, layer: string, bits: readonly string[], other: SolveName | null): Side | null {
  const {name, solve} = maps;
  if (!isThere(solve, layer)) return null;
  return {
    maps: addressOfMaps(name),
    pyramid: {size: {width: solve.width, height: solve.height}, side: solve.tile, levels: solve.levels},
    mode: modeOf(solve, layer),
    layer,
    other: isDifference(layer) && other ? textOf(other) : null,
    gain: isShaded(layer) ? solve.display_gain : 1,
    bits: isThere(solve, 'status') ? bits : [],
  };
}
