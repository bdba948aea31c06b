// SPDX-License-Identifier: Apache-2.0
// How a person likes the page, kept by this browser.
import {effect, signal, type Signal} from '@preact/signals';

export function kept<T>(name: string, first: T): Signal<T> {
  const key = `weft.desk.${name}`;
  const before = localStorage.getItem(key);
  const preference = signal<T>(before === null ? first : (JSON.parse(before) as T));
  effect(() => localStorage.setItem(key, JSON.stringify(preference.value)));
  return preference;
}
