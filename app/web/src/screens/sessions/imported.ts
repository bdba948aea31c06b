// SPDX-License-Identifier: Apache-2.0
// What an import made, for people: a few of its sessions by name, many of a kind in a sentence.
import {fieldsOf, listIn, textIn} from '../../ui/fields';

const mostShown = 8;

export type Imported = {
  /** Sessions that are shown, with those that were refused. */
  readonly shown: readonly unknown[];
  readonly more: number;
  /** Of all that is odd about many, and of files that are left over. */
  readonly sentences: readonly string[];
};

export function importedOf(result: unknown): Imported {
  const all = [...listIn(result, 'photographs'), ...listIn(result, 'sessions')];
  const oddities = listIn(result, 'oddities');
  if (all.length <= mostShown) {
    const leftOver = oddities.filter((each) => textIn(each, 'kind') === 'left_over');
    return {shown: all, more: 0, sentences: leftOver.map((each) => textIn(each, 'says'))};
  }
  const shown = all.filter((each) => !fieldsOf(each)['error']).slice(0, mostShown);
  return {shown, more: all.length - shown.length, sentences: oddities.map((each) => textIn(each, 'says'))};
}
