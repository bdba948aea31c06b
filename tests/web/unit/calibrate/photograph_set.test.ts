// SPDX-License-Identifier: Apache-2.0
import {describe, expect, test} from 'vitest';
import {
  arrowScale, coverageOf, factsOf, figuresOf, isMet, lastUsed, outlineWanted, residualOf, shareOf, takenBy, type PhotographSet,
} from '../../../../app/web/src/screens/calibrate/photograph_set';

/** As the daemon sent it, at 0.25 megapixel after two photographs. */
const set = {
  name: 'first-board', part: 'board', folder: '/rig/sets/first-board', from: '', busy: false, error: null, done: false,
  photographs: [
    {name: 'board01.dng', used: true, left_out: false, why: '', facts: {corners: 45, edge_px: 2.5, rms_px: 0.068}},
    {name: 'table01.dng', used: true, left_out: false, why: '', facts: {corners: 1, rms_px: 0.07, note: 'much like one before'}},
    {name: 'board02.dng', used: false, left_out: false, why: 'only 4 corners', facts: {corners: 4}},
  ],
  figures: {
    coverage: {columns: 3, rows: 2, corners: [0, 4, 0, 2, 9, 0], seen: 3},
    predicted: {focal_percent: 0.2, place_mm: 0.015}, asked: {focal_percent: 0.02, place_mm: 0.02}, then: {focal_percent: 0.1, place_mm: 0.012},
  },
  next: {name: 'board03', kind: 'photograph', says: 'tilt it', pose: {outline: [[0.1, 0.2], [0.9, 0.2], [0.9, 0.8], [0.1, 0.8]]}},
} as unknown as PhotographSet;

const empty = {...set, photographs: [], figures: {}, next: null} as unknown as PhotographSet;

describe('a set of photographs', () => {
  test('says how well the camera is known against what is asked', () => {
    const [focal, place] = figuresOf(set);
    expect(focal).toMatchObject({now: 0.2, asked: 0.02, then: 0.1, unit: '%'});
    expect(focal && [isMet(focal), shareOf(focal)]).toEqual([false, 0]);
    expect(place && [isMet(place), shareOf(place)]).toEqual([true, 1]);
  });

  test('says where corners were seen', () => expect(coverageOf(set)).toEqual({columns: 3, rows: 2, corners: [0, 4, 0, 2, 9, 0], seen: 3, residuals: []}));

  test('draws residuals so that the longest is half as wide as a part', () => {
    expect(arrowScale([[0.03, 0.04], [0, 0]])).toBeCloseTo(0.1);
    expect(arrowScale([[0, -0.051]])).toBeCloseTo(0.2);
    expect(arrowScale([[2, 0]])).toBeCloseTo(5);
  });

  test('answers each photograph', () => {
    expect(set.photographs.map(factsOf)).toEqual([['45 corners'], ['1 corner', 'much like one before'], ['4 corners']]);
    expect(set.photographs.map(residualOf)).toEqual([0.068, 0.07, null]);
  });

  test('finds what a step took, whatever its ending', () => {
    expect(takenBy(set, 'board02')?.why).toBe('only 4 corners');
    expect(takenBy(set, 'board0')).toBeNull();
  });

  test('knows the last that counts', () => expect(lastUsed(set)?.name).toBe('table01.dng'));

  test('draws the pose that is wanted where its place is said', () => {
    expect(outlineWanted(set)).toHaveLength(4);
    expect(outlineWanted({...set, next: {...set.next!, pose: {outline_px: [[1, 2]]} as never}})).toBeNull();
  });

  test('that is empty has nothing to show', () => {
    expect([figuresOf(empty), coverageOf(empty), outlineWanted(empty), lastUsed(empty)]).toEqual([[], null, null, null]);
  });
});
