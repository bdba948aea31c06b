// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {placeOf} from '../../../../app/web/src/state/place';

const placed = (path: string) => placeOf(new URL(path, 'http://127.0.0.1:8470'));

test('the bare address is no screen yet, and the library is at the name of its tab too', () => {
  expect(placed('/')).toMatchObject({screen: '', parts: []});
  expect(placed('/library/wool').screen).toBe('sessions');
});

test('names with dots and spaces come through', () => {
  expect(placed('/viewer/2026-11-21_wool.2_001/a%20b?layer=normal')).toMatchObject({screen: 'viewer', parts: ['2026-11-21_wool.2_001', 'a b']});
  expect(placed('/viewer/a/b?layer=normal').query.get('layer')).toBe('normal');
});

test('a slash at the end is no part', () => {
  expect(placed('/sessions/').parts).toEqual([]);
});
