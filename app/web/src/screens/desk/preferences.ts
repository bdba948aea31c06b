// SPDX-License-Identifier: Apache-2.0
// How a person likes the desk, kept by this browser.
import {effect, signal, type Signal} from '@preact/signals';

function kept<T>(name: string, first: T): Signal<T> {
  const key = `weft.desk.${name}`;
  const before = localStorage.getItem(key);
  const preference = signal<T>(before === null ? first : (JSON.parse(before) as T));
  effect(() => localStorage.setItem(key, JSON.stringify(preference.value)));
  return preference;
}

export const showsGrid = kept<boolean>('grid', true);
export const showsEdges = kept<boolean>('edges', false);
/** Turns the picture, for who sits on the other side. */
export const turn = kept<'0' | '180'>('turn', '0');

/** Whether a scan takes the first LED and the dark once more at its end. */
export const repeats = kept<boolean>('repeat', true);
/** A scan takes each LED once more at so many times the exposure; empty: it does not. */
export const bracket = kept<string>('bracket', '');
