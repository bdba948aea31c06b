// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {scanRequestOf, tagsOf} from '../../../../app/web/src/screens/desk/cloth';

const unsaid = {fabric: 'wool', id: '', tags: '', height_mm: '', exposure_ms: ''};

test('what is not said is left to the rig file', () => {
  expect(scanRequestOf({...unsaid, fabric: ' wool '})).toEqual({fabric: 'wool'});
});

test('a height of zero is said', () => {
  expect(scanRequestOf({...unsaid, height_mm: '0'})).toEqual({fabric: 'wool', cloth_height_mm: 0});
});

test('numbers may have a comma, and milliseconds become microseconds', () => {
  expect(scanRequestOf({...unsaid, height_mm: '1,5', exposure_ms: '12.5'})).toEqual({fabric: 'wool', cloth_height_mm: 1.5, exposure_us: 12500});
});

test('a barcode and tags are metadata', () => {
  expect(scanRequestOf({...unsaid, id: ' 4006 ', tags: 'red, ,raw '}).metadata).toEqual({id: '4006', tags: ['red', 'raw']});
  expect(tagsOf('')).toEqual([]);
});
