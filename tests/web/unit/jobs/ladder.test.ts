// SPDX-License-Identifier: Apache-2.0
import {describe, expect, test} from 'vitest';
import {drawable, levelsIn, worthwhile, type Level} from '../../../../app/web/src/screens/jobs/ladder';

const priced = (quality: string, predicted_deg: number, total: number, solved = 1) => ({
  quality, predicted_deg, solved, parts_deg: {noise: 0.1, model: 0.2, calibration: 0.05}, seconds: {read: 1, total}, note: '',
});

describe('the levels of a price', () => {
  test('are read with their parts and whole seconds', () => {
    expect(levelsIn({levels: [priced('fast', 0.4, 3)], gates: []})).toEqual([
      {quality: 'fast', predicted_deg: 0.4, solved: 1, parts_deg: {noise: 0.1, model: 0.2, calibration: 0.05}, seconds: 3, note: ''},
    ]);
  });

  test('are none of a job that has not ended', () => {
    expect(levelsIn(null)).toEqual([]);
    expect(levelsIn({levels: [{quality: 'fast'}]})).toEqual([]);
  });

  test('are worth their time where nothing cheaper is as good', () => {
    const levels = levelsIn({levels: [priced('preview', 1, 0.5), priced('fast', 0.4, 3), priced('standard', 0.4, 9), priced('robust', 0.3, 20)]});
    expect(worthwhile(levels).map((level: Level) => level.quality)).toEqual(['preview', 'fast', 'robust']);
  });

  test('are not worth their time where they solve nothing, however small the error of nothing is', () => {
    const levels = levelsIn({levels: [priced('preview', 0, 0.5, 0), priced('fast', 0.3, 3, 0.2), priced('standard', 0.5, 9, 0.98)]});
    expect(worthwhile(levels).map((level: Level) => level.quality)).toEqual(['standard']);
    expect(drawable(levels).map((level: Level) => level.quality)).toEqual(['fast', 'standard']);
  });
});
