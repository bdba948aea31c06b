// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {toMap} from '../../../../app/web/src/gl/view';
import {boxBetween, onDisc, pinched} from '../../../../app/web/src/screens/viewer/hand';

const map = {width: 100, height: 80};

test('a rectangle has whole pixels, from whichever corner it is drawn', () => {
  const box = {x: 10, y: 20, width: 6, height: 3};
  expect(boxBetween({x: 10.2, y: 20.9}, {x: 15.9, y: 22.1}, map)).toEqual(box);
  expect(boxBetween({x: 15.9, y: 22.1}, {x: 10.2, y: 20.9}, map)).toEqual(box);
});

test('a rectangle ends at the map', () => {
  expect(boxBetween({x: -50, y: 70}, {x: 500, y: 500}, map)).toEqual({x: 0, y: 70, width: 100, height: 10});
});

test('the disc of lights is as high as the canvas', () => {
  expect(onDisc({x: 400, y: 0}, {width: 800, height: 600})).toEqual({x: 0, y: -1});
});

test('two fingers hold what lies between them', () => {
  const canvas = {width: 800, height: 600};
  const view = {x: 50, y: 40, zoom: 4};
  const before: [{x: number; y: number}, {x: number; y: number}] = [{x: 300, y: 300}, {x: 400, y: 300}];
  const now: typeof before = [{x: 260, y: 320}, {x: 460, y: 320}];
  const after = pinched(view, before, now, canvas);
  expect(after.zoom).toBe(8);
  const held = toMap({x: 350, y: 300}, view, canvas);
  const where = toMap({x: 360, y: 320}, after, canvas);
  expect(Math.abs(where.x - held.x)).toBeLessThan(0.3);
  expect(Math.abs(where.y - held.y)).toBeLessThan(0.3);
});
