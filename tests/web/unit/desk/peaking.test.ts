// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {gradientsOf, quantileOf} from '../../../../app/web/src/screens/desk/peaking';

test('a step has its height on both of its sides, and the border nothing', () => {
  const row = [10, 10, 10, 50, 50, 50];
  const gradients = gradientsOf(Uint8Array.from([...row, ...row, ...row]), 6, 3);
  expect([...gradients.slice(6, 12)]).toEqual([0, 0, 40, 40, 0, 0]);
  expect(Math.max(...gradients.slice(0, 6))).toBe(0);
});

test('values are ordered by number and not by word', () => {
  expect(quantileOf(Uint16Array.from([100, 9, 20]), 0.5)).toBe(20);
  expect(quantileOf(Uint16Array.from([100, 9, 20]), 0)).toBe(9);
});
