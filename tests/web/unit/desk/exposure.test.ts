// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {scanRequestOf} from '../../../../app/web/src/screens/desk/cloth';
import {chosenIn, exposureIn, exposureInWords, millisecondsOf} from '../../../../app/web/src/screens/desk/exposure';

/** Thirds of stops as a camera names them, 1/4000 s to 30 s. */
const times_us = [250, 312.5, 1000, 8000, 10_000, 12_500, 1e6 / 60, 20_000, 400_000, 1_300_000, 1_600_000, 30_000_000];

test('an exposure is typed as milliseconds, as a fraction of a second, or with its unit', () => {
  expect(['16.2', '16,2 ms', '1/80', '1 / 80 s', '0.5 s', '500us'].map(exposureIn)).toEqual([16_200, 16_200, 12_500, 12_500, 500_000, 500]);
  expect(['', 'fast', '-3', '0', '1/0', '1e3', '12 minutes'].map(exposureIn)).toEqual([null, null, null, null, null, null, null]);
});

test('what is typed becomes the nearest time of the camera, and that is said', () => {
  expect(chosenIn('16.16', times_us)).toEqual({exposure_us: 1e6 / 60, says: '16.7 ms (1/60 s) is the camera\'s nearest.', isWrong: false});
  expect(chosenIn('1500', times_us)).toMatchObject({exposure_us: 1_600_000, isWrong: false});
  expect(chosenIn('16.7', times_us)).toEqual({exposure_us: 1e6 / 60, says: '16.7 ms (1/60 s)', isWrong: false});
});

test('what lies beyond all of the camera\'s times, and what is no time, cannot be scanned with', () => {
  expect(chosenIn('0.22', times_us)).toEqual({exposure_us: null, says: 'The camera has 0.25 ms (1/4000 s) to 30 s.', isWrong: true});
  expect(chosenIn('34000', times_us)).toMatchObject({isWrong: true});
  expect(chosenIn('33000', times_us)).toMatchObject({exposure_us: 30_000_000, isWrong: false});
  expect(chosenIn('abc', times_us)).toMatchObject({exposure_us: null, isWrong: true});
});

test('as long as the camera was not asked for its times, the daemon decides', () => {
  expect(chosenIn('16.16', [])).toMatchObject({exposure_us: 16_160, isWrong: false});
});

test('each time of the camera is itself again as the field has it', () => {
  for (const us of times_us) expect(chosenIn(millisecondsOf(us), times_us).exposure_us).toBe(us);
});

test('a scan asks for the time that is chosen, and for none where it is metered', () => {
  const cloth = {fabric: 'wool', id: '', tags: '', height_mm: '', exposure_ms: '16.2'};
  const shots = {repeat: true, bracket: ''};
  expect(scanRequestOf(cloth, shots, times_us).exposure_us).toBe(1e6 / 60);
  expect(scanRequestOf({...cloth, exposure_ms: ' '}, shots, times_us)).not.toHaveProperty('exposure_us');
});

test('exposures are written as people do', () => {
  expect([250, 12_500, 400_000, 1_500_000, 30_000_000].map(exposureInWords)).toEqual(['0.25 ms (1/4000 s)', '12.5 ms (1/80 s)', '400 ms', '1.5 s', '30 s']);
});
