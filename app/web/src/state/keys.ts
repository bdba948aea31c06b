// SPDX-License-Identifier: Apache-2.0
// The one registry of keys. A key means one thing on a screen, and what means something everywhere means nothing else.
import {signal} from '@preact/signals';
import {useEffect, useRef} from 'preact/hooks';

export interface Key {
  /** As keyName has it: 'Space', 'Escape', 'd', '?', 'ArrowLeft', 'Ctrl+z', 'Ctrl+Shift+z'. */
  key: string;
  /** In words, for the list of keys. */
  does: string;
  run: () => void;
}
export const everywhere = 'everywhere';

/** Screen by screen, what is listened for now. */
export const registry = signal<ReadonlyMap<string, readonly Key[]>>(new Map());

function refuseDoubles(screen: string, keys: readonly Key[]): void {
  const taken = new Map<string, string>();
  const inForce = [...registry.value].filter(([name]) => name === screen || name === everywhere || screen === everywhere);
  for (const {key, does} of [...inForce.flatMap(([, those]) => those), ...keys]) {
    const other = taken.get(key);
    if (other !== undefined) throw new Error(`the key ${key} is given twice: "${other}" and "${does}"`);
    taken.set(key, does);
  }
}

/** Adds keys to a screen's; returns what takes them back. A key that is taken already is an error. */
export function register(screen: string, keys: readonly Key[]): () => void {
  refuseDoubles(screen, keys);
  registry.value = new Map(registry.value).set(screen, [...(registry.value.get(screen) ?? []), ...keys]);
  return () => {
    const left = (registry.value.get(screen) ?? []).filter((key) => !keys.includes(key));
    const others = new Map(registry.value);
    if (left.length) others.set(screen, left);
    else others.delete(screen);
    registry.value = others;
  };
}

/** Keys of a component for as long as it is shown. Which keys and what they do stays; what they run may change. */
export function useKeys(screen: string, keys: readonly Key[]): void {
  const current = useRef(keys);
  current.current = keys;
  useEffect(
    () => register(screen, keys.map((key, index) => ({...key, run: () => current.current[index]?.run()}))),
    [screen],
  );
}

/** A space is the only key without a name of its own; what Shift makes is in the name already. */
export function keyName(event: KeyboardEvent): string {
  const name = event.key === ' ' ? 'Space' : event.key;
  const hasControl = event.ctrlKey || event.metaKey;
  const shift = event.shiftKey && (hasControl || name.length > 1) ? 'Shift+' : '';
  return hasControl ? `Ctrl+${shift}${name.toLowerCase()}` : shift + name;
}

const typing = 'input:not([type=checkbox]):not([type=radio]):not([type=range]), textarea, select';
const pressing = 'button, a[href], summary, input';

function belongsToElement(event: KeyboardEvent, name: string): boolean {
  const target = event.target as Element;
  if (target.matches(typing)) return true;
  const isSlider = target.matches('input[type=range]') && name.includes('Arrow');
  return isSlider || (target.matches(pressing) && (name === 'Space' || name === 'Enter'));
}

/** Out of a text field, so that keys are keys again. */
function leaveField(event: KeyboardEvent): void {
  const target = event.target as HTMLElement;
  if (event.key === 'Escape' && target.matches(typing)) target.blur();
}

function press(event: KeyboardEvent): void {
  leaveField(event);
  const name = keyName(event);
  if (event.defaultPrevented || event.altKey || belongsToElement(event, name)) return;
  const key = [...registry.value.values()].flat().find((those) => those.key === name);
  if (!key) return;
  event.preventDefault();
  if (!event.repeat || name.includes('Arrow')) key.run();
}

/** Begins to listen. */
export function followKeys(): void {
  addEventListener('keydown', press);
}
