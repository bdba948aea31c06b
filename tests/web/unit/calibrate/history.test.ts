// SPDX-License-Identifier: Apache-2.0
import {describe, expect, test} from 'vitest';
import {historyOf, noHistory, seriesOfCamera, seriesOfFluxes, seriesOfPlaces, sideBySide, type Series} from '../../../../app/web/src/screens/calibrate/history';

const document = {
  title: 'History of north', summary: '2 calibrations and 1 check', warnings: ['one says no time'],
  numbers: {
    calibrations: [
      {measured: '2026-11-20T10:00:00Z', folder: 'calibrations/first-lights', id: 'a', leds: [{led: 1, position_mm: [100, 0, 600], flux_rgb: [1, 2, 1]}], camera_height_mm: 612.5},
      {measured: '2026-11-22T10:00:00Z', folder: 'calibrations/knock-updated', id: 'b', leds: [{led: 1, position_mm: [103, 4, 600], flux_rgb: [1, 1.96, 1]}], camera_height_mm: 612.1},
    ],
    checks: [{date: '2026-11-21T10:00:00Z', folder: 'calibrations/knock-moved', calibration: 'a', passed: false, found: 'led 3'}],
    affected: [{session: '/rig/scans/2026-11-21_madder_001.weft', time: '2026-11-21T09:00:00Z', after_move: false, concerned: true, says: 'camera moved 3.0 mm', predicted_mean_deg: 0.4}],
    looks: [{session: 'a', taken: '2026-11-21T09:00:00Z', cost_mean_deg: 0.12}],
  },
};

describe('the history of a rig', () => {
  test('is series of what was measured', () => {
    const history = historyOf(document);
    const values = (series: Series[]) => series.map(({name, points}) => [name, ...points.map(({value}) => value)]);
    expect(values(seriesOfCamera(history))).toEqual([['', 612.5, 612.1]]);
    expect(history.costs).toEqual([{time_ms: Date.parse('2026-11-21T09:00:00Z'), value: 0.12}]);
    expect(values(seriesOfPlaces(history))).toEqual([['LED 1', 0, 5]]);
    expect(values(seriesOfFluxes(history))).toEqual([['LED 1', 100, 98]]);
    expect(history.checks[0]).toMatchObject({passed: false, found: 'led 3'});
  });

  test('names affected sessions as the library does', () => {
    expect(historyOf(document).affected).toEqual([
      {session: '2026-11-21_madder_001', time: '2026-11-21T09:00:00Z', says: 'camera moved 3.0 mm', isConcerned: true, mean_deg: 0.4},
    ]);
  });

  test('is empty where nothing was measured', () => expect(historyOf({summary: '', numbers: null})).toEqual(noHistory));
});

test('names of lines that end together stand side by side', () => {
  const at = (text: string, y: number) => ({text, x: 5, y});
  expect(sideBySide([at('1', 40), at('2', 12), at('3', 45), at('4', 22)])).toEqual([at('2', 12), at('4', 22), at('1 3', 40)]);
});
