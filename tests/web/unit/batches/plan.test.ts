// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {firstWish, levelPoints, requestOf, scopeIn, scopeInWords} from '../../../../app/web/src/screens/batches/plan';

const scope = {sessions: ['a', 'b']};

test('a level, hours or degrees are asked for, and never two of them', () => {
  expect(requestOf(scope, firstWish)).toEqual({kind: 'batch_plan', sessions: ['a', 'b'], quality: 'standard'});
  expect(requestOf(scope, {...firstWish, aim: 'hours', hours: '1.5'})).toEqual({kind: 'batch_plan', sessions: ['a', 'b'], within_s: 5400});
  expect(requestOf({find: {tag: 'wool'}}, {...firstWish, aim: 'degrees', degrees: '0.5'}, {least_change_deg: 0.2, sample: 0})).toEqual({
    kind: 'batch_plan', find: {tag: 'wool'}, to_deg: 0.5, least_change_deg: 0.2, sample: 0,
  });
});

test('sessions that a move spoiled are planned by the corrected calibration', () => {
  expect(requestOf({sessions: ['a'], calibration: 'calibrations/may'}, firstWish)).toEqual({
    kind: 'batch_plan', sessions: ['a'], calibration: 'calibrations/may', quality: 'standard',
  });
});

test('what cannot be asked for is said in a sentence', () => {
  for (const [wish, word] of [
    [{aim: 'hours', hours: ''}, /Hours/], [{aim: 'hours', hours: '-1'}, /Hours/], [{aim: 'degrees', degrees: 'few'}, /Degrees/],
  ] as const) {
    expect(requestOf(scope, {...firstWish, ...wish}), JSON.stringify(wish)).toMatch(word);
  }
  expect(requestOf({sessions: []}, firstWish)).toMatch(/Choose sessions/);
});

test('a search in the address is what is planned', () => {
  expect(scopeIn(new URLSearchParams(''))).toBeNull();
  const found = scopeIn(new URLSearchParams('plan=found&words=red%20wool&warned=1'));
  expect(found).toEqual({find: {query: 'red wool', warned: 'true'}});
  expect(scopeInWords(found!)).toBe('all sessions by with warnings, query red wool');
  expect(scopeInWords({find: {}})).toBe('all sessions of the library');
  expect(scopeInWords(scope)).toBe('2 chosen sessions');
  expect(scopeInWords({sessions: ['a'], calibration: 'calibrations/may'})).toBe('1 chosen session by calibrations/may');
});

test('only what was measured stands in the plot', () => {
  const level = {spread_deg: 0, solved: 1, sessions: 0};
  expect(levelPoints({levels: [{quality: 'fast', seconds: 3, mean_deg: 0.5, ...level}, {quality: 'robust', seconds: 0, mean_deg: 0, ...level}]}))
    .toEqual([{name: 'fast', seconds: 3, mean_deg: 0.5}]);
});
