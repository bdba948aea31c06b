// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {exposedOf, highlightOf, lessThan} from '../../../../app/web/src/screens/desk/clipping';

/** All photosites but `share` in the darkest bin, those in `bin`. */
function binsWith(bin: number, share = 0.01): number[] {
  const bins = new Array<number>(64).fill(0);
  bins[0] = 1000 * (1 - share);
  bins[bin] = (bins[bin] ?? 0) + 1000 * share;
  return bins;
}

function histogram(bin: number, clipped = 0) {
  const channel = {bins: binsWith(bin), clipped};
  return {red: channel, green: {bins: binsWith(0), clipped: 0}, blue: {bins: binsWith(0), clipped: 0}};
}

test('the brightest thousandth is found from above', () => {
  expect(highlightOf(binsWith(31))).toBe(0.5);
  expect(highlightOf(binsWith(63, 0.0005))).toBe(1 / 64);
});

test('headroom is counted in stops', () => {
  expect(exposedOf(histogram(31))).toEqual({verdict: 'fine', word: 'good', clipped: 0, headroom_stops: 1});
  expect(exposedOf(histogram(15)).headroom_stops).toBe(2);
});

test('the worst channel decides: near from a thousandth, over from a hundredth', () => {
  expect(exposedOf(histogram(60, 0.0009)).word).toBe('good');
  expect(exposedOf(histogram(60, 0.001)).word).toBe('near');
  expect(exposedOf(histogram(60, 0.01))).toMatchObject({verdict: 'fault', word: 'over', headroom_stops: null});
});

test('a tenth of full is too dark', () => {
  expect(exposedOf(histogram(5)).word).toBe('dark');
});

test('what is over is shot again by two stops less, or by what was measured nearest to that', () => {
  expect(lessThan(400_000, [])).toBe(100_000);
  expect(lessThan(400_000, [12_500, 80_000, 200_000, 800_000])).toBe(80_000);
  expect(lessThan(400_000, [800_000])).toBe(100_000);
});
