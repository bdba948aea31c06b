// SPDX-License-Identifier: Apache-2.0
// Which sessions of a list are chosen, and from where a range begins.

export interface Selection {
  readonly names: ReadonlySet<string>;
  readonly anchor: string | null;
}

export const nothing: Selection = {names: new Set(), anchor: null};

export function toggled(selection: Selection, name: string): Selection {
  const names = new Set(selection.names);
  if (!names.delete(name)) names.add(name);
  return {names, anchor: name};
}

/** With all from the anchor to this one, as the list has them. */
export function extended(selection: Selection, name: string, list: readonly string[]): Selection {
  const begin = selection.anchor === null ? -1 : list.indexOf(selection.anchor);
  const end = list.indexOf(name);
  if (begin < 0 || end < 0) return toggled(selection, name);
  const range = list.slice(Math.min(begin, end), Math.max(begin, end) + 1);
  return {names: new Set([...selection.names, ...range]), anchor: selection.anchor};
}

export function all(list: readonly string[]): Selection {
  return {names: new Set(list), anchor: null};
}
