// SPDX-License-Identifier: Apache-2.0
// The maps of a solve as the daemon tells of them, and a side of the picture made of them.
import {answer, api} from '../../api/client';
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
  return `/api/v1/sessions/${encodeURIComponent(name.session)}/solves/${encodeURIComponent(name.solve)}`;
}

export async function loadMaps(name: SolveName): Promise<Maps> {
  const solve = await answer(
    api.GET('/api/v1/sessions/{name}/solves/{solve}', {params: {path: {name: name.session, solve: name.solve}}}),
  );
  return {name, solve};
}

export function isSameSize(a: Maps, b: Maps): boolean {
  return a.solve.width === b.solve.width && a.solve.height === b.solve.height;
}

/** These maps shown as a layer, and bits of their status over it. Null where they have no such layer. */
export function sideOf(maps: Maps, layer: string, bits: readonly string[], other: SolveName | null): Side | null {
  const {name, solve} = maps;
  if (!isThere(solve, layer)) return null;
  return {
    maps: addressOfMaps(name),
    pyramid: {size: {width: solve.width, height: solve.height}, side: solve.tile, levels: solve.levels},
    mode: modeOf(layer),
    scalar: layer,
    other: isDifference(layer) && other ? textOf(other) : null,
    gain: solve.display_gain,
    bits: isThere(solve, 'status') ? bits : [],
  };
}
