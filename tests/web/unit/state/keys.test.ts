// SPDX-License-Identifier: Apache-2.0
import {afterEach, expect, test} from 'vitest';
import {everywhere, keyName, register, registry} from '../../../../app/web/src/state/keys';

const undo: (() => void)[] = [];
afterEach(() => undo.splice(0).forEach((back) => back()));

function give(screen: string, ...keys: string[]): void {
  undo.push(register(screen, keys.map((key) => ({key, does: `what ${key} does`, run: () => {}}))));
}

function pressed(key: string, held: Partial<KeyboardEvent> = {}): KeyboardEvent {
  return {key, ctrlKey: false, metaKey: false, shiftKey: false, ...held} as KeyboardEvent;
}

test('a key is given once on a screen', () => {
  give('desk', 'n');
  expect(() => give('desk', 'n')).toThrow('the key n is given twice');
  expect(() => give('viewer', 'd', 'd')).toThrow('the key d is given twice');
});

test('two screens may give a key two meanings', () => {
  give('desk', 'r');
  give('viewer', 'r');
  expect([...registry.value.keys()]).toEqual(['desk', 'viewer']);
});

test('what a key means everywhere it means nowhere else', () => {
  give(everywhere, '?');
  expect(() => give('desk', '?')).toThrow();
  give('jobs', 'f');
  expect(() => give(everywhere, 'f')).toThrow();
});

test('a screen that is left gives its keys back', () => {
  const leave = register('desk', [{key: 'v', does: 'live view', run: () => {}}]);
  leave();
  expect(registry.value.size).toBe(0);
  give('desk', 'v');
});

test('keys have the names that people press', () => {
  expect(keyName(pressed(' '))).toBe('Space');
  expect(keyName(pressed('?', {shiftKey: true}))).toBe('?');
  expect(keyName(pressed('ArrowLeft', {shiftKey: true}))).toBe('Shift+ArrowLeft');
  expect(keyName(pressed('Z', {ctrlKey: true, shiftKey: true}))).toBe('Ctrl+Shift+z');
  expect(keyName(pressed('z', {metaKey: true}))).toBe('Ctrl+z');
});
