// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {azimuthDeg, heightDeg, lightAt, lightInWords, nudged, placeOf} from '../../../../app/web/src/screens/viewer/light';

test('the middle of the disc is straight above, up on the screen is up on the cloth', () => {
  expect(lightAt({x: 0, y: 0})).toEqual([0, -0, 1]);
  const [x, y, z] = lightAt({x: 0, y: -0.6});
  expect([x, y]).toEqual([0, 0.6]);
  expect(z).toBeCloseTo(0.8, 12);
});

test('no light is lower than five degrees, however far the hand goes', () => {
  for (const x of [1, 2, 100]) expect(heightDeg(lightAt({x, y: -x}))).toBeCloseTo(5, 6);
});

test('a light is unit and comes back from its place', () => {
  const light = lightAt({x: 0.3, y: 0.5});
  expect(Math.hypot(...light)).toBeCloseTo(1, 12);
  expect(placeOf(light)).toEqual({x: 0.3, y: 0.5});
});

test('words say side and height', () => {
  expect(lightInWords([-0.5, 0.5, Math.SQRT1_2])).toBe('from the upper left, 45 degrees high');
  expect(lightInWords([0, 0, 1])).toBe('from straight above');
  expect(lightInWords(lightAt({x: 0.01, y: 0.9}))).toMatch(/^from the bottom, 26 degrees/);
  expect([{x: 0, y: -1}, {x: -1, y: 0}, {x: 0, y: 1}].map((place) => azimuthDeg(lightAt(place)))).toEqual([90, 180, 270]);
});

test('a key turns the light a little', () => {
  const [x] = nudged([0, 0, 1], {x: 0.08, y: 0});
  expect(x).toBeCloseTo(0.08, 12);
});
