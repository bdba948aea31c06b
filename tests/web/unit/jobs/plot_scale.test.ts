// SPDX-License-Identifier: Apache-2.0
import {describe, expect, test} from 'vitest';
import {lanesOf, linearScale, logScale} from '../../../../app/web/src/ui/plot_scale';

describe('a linear scale', () => {
  test('goes from a round number to a round number around all values', () => {
    const {place, ticks} = linearScale([0, 0.83]);
    expect(ticks).toEqual([0, 0.5, 1]);
    expect(place(0)).toBe(0);
    expect(place(1)).toBe(1);
  });

  test('has a span where all values are one', () => {
    const {place, ticks} = linearScale([599.99, 599.99], 1);
    expect(ticks).toEqual([599, 599.5, 600, 600.5]);
    expect(place(599.99)).toBeCloseTo(0.66, 9);
  });
});

describe('a logarithmic scale', () => {
  const {place, ticks} = logScale([0.4, 55]);

  test('has all values inside, and ticks at 1, 2 and 5 of each decade', () => {
    expect(place(0.4)).toBeGreaterThan(0);
    expect(place(55)).toBeLessThan(1);
    expect(ticks).toEqual([0.2, 0.5, 1, 2, 5, 10, 20, 50, 100]);
  });

  test('is as far from 1 to 10 as from 10 to 100', () => {
    expect(place(10) - place(1)).toBeCloseTo(place(100) - place(10), 12);
  });
});

test('names that would lie over each other are in lanes', () => {
  const lanes = lanesOf([300, 100, 130, 150, 400], (x) => x, 74);
  expect([100, 130, 150, 300, 400].map((x) => lanes.get(x))).toEqual([0, 1, 2, 0, 0]);
});
