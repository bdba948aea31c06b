// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {lengthInWords, measured, roundBelow, scaleBar, zoomInWords} from '../../../../app/web/src/screens/viewer/bars';
import {fullScale} from '../../../../app/web/src/screens/viewer/layers';

test('a bar is as long as it says', () => {
  const bar = scaleBar(0.04, 2, 160);
  expect(bar.says).toBe('2 mm');
  expect(bar.length).toBeCloseTo((2 / 0.04) * 2, 9);
  expect(bar.length).toBeLessThanOrEqual(160);
});

test('without millimetres it counts pixels', () => expect(scaleBar(null, 0.5, 160)).toEqual({length: 100, says: '200 px'}));

test('lengths are 1, 2 or 5 of a decade', () => {
  expect([0.9, 1, 1.99, 2, 4.9, 5, 999].map(roundBelow)).toEqual([0.5, 1, 1, 2, 2, 5, 500]);
});

test('lengths have the unit that people use', () => {
  expect([0.05, 0.5, 2, 200].map(lengthInWords)).toEqual(['50 µm', '0.5 mm', '2 mm', '20 cm']);
});

test('digits end where the uncertainty begins', () => {
  expect(measured(10.77123, 0.0112)).toBe('10.771 mm ± 0.011 mm');
  expect(measured(10.77123, 0.4)).toBe('10.77 mm ± 0.40 mm');
  expect(measured(10.77123, null)).toBe('10.771 mm, uncertainty not known');
});

test('a zoom is told as a ratio', () => expect([1, 4, 0.5, 0.3].map(zoomInWords)).toEqual(['1:1', '4:1', '1:2', '1:3.33']));

test('a scale of colours is the least round one that holds the values', () => {
  expect([0.02, 0.3, 2.98, 12, 100].map(fullScale)).toEqual([0.03, 0.3, 3, 30, 180]);
});
