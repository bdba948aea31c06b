// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {type ClothExtent, laidOut} from '../../../../app/web/src/screens/material/shape';
import {FIRST} from '../../../../app/web/src/screens/material/material_sight';

const canvas = {width: 900, height: 600};
const tile: ClothExtent = {size_mm: [30, 20], is_known: true, repeats: true};
const piece: ClothExtent = {size_mm: [30, 20], is_known: true, repeats: false};
const screen = 4;

test('at true size a millimetre is that of the screen, whatever the cloth', () => {
  for (const cloth of [tile, piece]) {
    expect(laidOut(cloth, {...FIRST, shape: 'true'}, canvas, screen)).toMatchObject({px_per_mm: screen, radius_mm: 0, slant_deg: 0});
  }
  expect(laidOut(tile, {...FIRST, shape: 'true'}, canvas, screen).cells).toBe(null);
  expect(laidOut(piece, {...FIRST, shape: 'true'}, canvas, screen).cells).toBe(1);
});

test('what nobody knows the millimetres of is shown at no true size', () => {
  const unknown: ClothExtent = {...tile, is_known: false};
  expect(laidOut(unknown, {...FIRST, shape: 'true'}, canvas, screen)).toEqual(laidOut(unknown, FIRST, canvas, screen));
});

test('a plane shows all its repeats, and one piece where borders do not fit', () => {
  const twice = laidOut(tile, {...FIRST, shape: 'plane', repeat: 2, lean_deg: 30}, canvas, screen);
  expect(twice).toMatchObject({cells: 2, slant_deg: 30});
  expect(twice.px_per_mm * 60).toBeLessThanOrEqual(900);
  expect(twice.px_per_mm).toBeCloseTo((0.94 * 900) / 60, 9);
  expect(laidOut(piece, {...FIRST, shape: 'plane', repeat: 3}, canvas, screen).cells).toBe(1);
});

test('a piece that does not repeat covers half a ball, and a tile one of the size that is asked for', () => {
  const ball = laidOut(piece, FIRST, canvas, screen);
  expect(Math.PI * ball.radius_mm).toBeCloseTo(20, 9);
  expect(ball.cells).toBe(1);
  const other = laidOut(tile, {...FIRST, ball_mm: 150}, canvas, screen);
  expect(other.radius_mm).toBe(75);
  expect(other.px_per_mm * 150).toBeCloseTo(0.94 * 600, 9);
});
