// SPDX-License-Identifier: Apache-2.0
import {describe, expect, test} from 'vitest';
import {all, extended, nothing, toggled} from '../../../../app/web/src/screens/sessions/selection';

const list = ['a', 'b', 'c', 'd', 'e'];

describe('a selection', () => {
  test('takes a name in and lets it go', () => {
    const chosen = toggled(nothing, 'b');
    expect([...chosen.names]).toEqual(['b']);
    expect([...toggled(chosen, 'b').names]).toEqual([]);
    expect([...nothing.names]).toEqual([]);
  });

  test('extends from where it began, both ways, and keeps the rest', () => {
    const down = extended(toggled(nothing, 'b'), 'd', list);
    expect([...down.names].sort()).toEqual(['b', 'c', 'd']);
    const up = extended(down, 'a', list);
    expect([...up.names].sort()).toEqual(['a', 'b', 'c', 'd']);
  });

  test('begins a range at the name itself where its begin is no longer listed', () => {
    expect([...extended(toggled(nothing, 'gone'), 'c', list).names].sort()).toEqual(['c', 'gone']);
  });

  test('holds all', () => expect(all(list).names.size).toBe(5));
});
