// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {scanRequestOf, tagsOf, withShots} from '../../../../app/web/src/screens/desk/cloth';

const unsaid = {fabric: 'wool', id: '', tags: '', height_mm: '', exposure_ms: ''};
const shots = {repeat: true, bracket: ''};

test('what is not said is left to the rig file', () => {
  expect(scanRequestOf({...unsaid, fabric: ' wool '}, shots)).toEqual({fabric: 'wool', repeat: true});
});

test('a height of zero is said', () => {
  expect(scanRequestOf({...unsaid, height_mm: '0'}, shots).cloth_height_mm).toBe(0);
});

test('numbers may have a comma, and milliseconds become microseconds', () => {
  expect(scanRequestOf({...unsaid, height_mm: '1,5', exposure_ms: '12.5'}, shots)).toMatchObject({cloth_height_mm: 1.5, exposure_us: 12500});
});

test('a barcode and tags are metadata', () => {
  expect(scanRequestOf({...unsaid, id: ' 4006 ', tags: 'red, ,raw '}, shots).metadata).toEqual({id: '4006', tags: ['red', 'raw']});
  expect(tagsOf('')).toEqual([]);
});

test('that there is no repeat is said, and a bracket where there is one', () => {
  expect(scanRequestOf(unsaid, {repeat: false, bracket: '0,25'})).toEqual({fabric: 'wool', repeat: false, bracket: 0.25});
  expect(scanRequestOf(unsaid, {repeat: false, bracket: ' '})).not.toHaveProperty('bracket');
});

test('shots that were bought stand in the place of those that the form has', () => {
  const request = {...scanRequestOf(unsaid, {repeat: true, bracket: '4'}), metadata: {id: '4006'}};
  const taken = JSON.parse(JSON.stringify(withShots(request, {leds: [1, 4, 7], repeat: false, bracket: null, polariser: []})));
  expect(taken).toEqual({fabric: 'wool', metadata: {id: '4006'}, leds: [1, 4, 7], repeat: false});
  expect(withShots(request, {leds: [1], repeat: true, bracket: 16, polariser: ['crossed']})).toMatchObject({bracket: 16, polariser: ['crossed']});
});
