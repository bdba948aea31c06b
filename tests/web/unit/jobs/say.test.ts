// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {age, counted, degrees, degreesOn, digits, shutter} from '../../../../app/web/src/ui/say';

test('two digits that matter are written', () => {
  expect([0.0034123, 0.413, 3.14, 41.4, 0].map((value) => digits(value))).toEqual(['0.0034', '0.41', '3.1', '41', '0']);
  expect(degrees(0.0812)).toBe('0.081°');
});

test('an error is told with the share of the cloth that it holds for', () => {
  const told = ([[0.77, 1], [0.248, 0.108], [0.77, 0.981], [0.77, 0.99999], [0.3, 0.0002], [0, 0]] as const).map(([value, solved]) => degreesOn(value, solved));
  expect(told).toEqual(['0.77° on 100 %', '0.25° on 11 %', '0.77° on 98 %', '0.77° on over 99 %', '0.30° on 0.020 %', 'nothing solved']);
});

test('one is singular', () => expect([counted(1, 'solve'), counted(2, 'solve')]).toEqual(['1 solve', '2 solves']));

test('an age is told in its largest unit', () => {
  const now = Date.parse('2026-11-24T12:00:00Z');
  const ages = ['2026-11-24T11:59:30Z', '2026-11-24T11:58:59Z', '2026-11-24T09:00:00Z', '2026-11-21T12:00:00Z', 'never'];
  expect(ages.map((iso) => age(iso, now))).toEqual(['just now', '1 minute ago', '3 hours ago', '3 days ago', '']);
});

test('an exposure is told as cameras do', () => {
  expect([4000, 40_000, 400_000, 2.5e6].map(shutter)).toEqual(['1/250 s', '1/25 s', '0.40 s', '2.5 s']);
});
