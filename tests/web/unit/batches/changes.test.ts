// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {acceptanceInWords, changeInCells} from '../../../../app/web/src/screens/batches/changes';

test('a change is angles, albedo and sigma', () => {
  const change = {mean_deg: 3.456, p95_deg: 12, albedo_bias_rel: 0.0123, sigma_deg: {before: 0.5, after: 0.91}};
  expect(changeInCells({change})).toEqual(['3.5°', '12°', '+1.2 %', '0.50° → 0.91°']);
  expect(changeInCells({change: {}})).toEqual(['0°', '0°', '0 %', '']);
});

test('what accepting does is said with its numbers before it is done', () => {
  expect(acceptanceInWords({moved: 12, left: 1})).toBe('12 sessions get their new solve as the current one; 1 session stays as it is.');
  expect(acceptanceInWords({moved: 1, left: 0})).toBe('1 session gets its new solve as the current one; none stays as it is.');
});
