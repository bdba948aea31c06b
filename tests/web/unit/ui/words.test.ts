// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {bytesOf, durationOf, percentOf} from '../../../../app/web/src/ui/words';

test('seconds are said as people say them', () => {
  expect([0.42, 9.96, 59.4, 59.6, 200, 7500].map(durationOf)).toEqual(['0.4 s', '10 s', '59 s', '1 min 0 s', '3 min 20 s', '2 h 5 min']);
});

test('bytes have a digit where it means something', () => {
  expect([900, 1200, 12_000, 999_600, 3.4e9].map(bytesOf)).toEqual(['900 B', '1.2 kB', '12 kB', '1.0 MB', '3.4 GB']);
});

test('shares are in percent', () => {
  expect([0, 0.00002, 0.041, 0.37].map(percentOf)).toEqual(['0 %', '0.002 %', '4.1 %', '37 %']);
});
