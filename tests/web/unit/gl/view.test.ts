// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {fitted, held, nextZoom, originOf, panned, toCanvas, toMap, zoomed} from '../../../../app/web/src/gl/view';

const canvas = {width: 1001, height: 701};

test('a point of the map comes back from the canvas', () => {
  const view = {x: 123.4, y: 56.7, zoom: 2.5};
  const there = toCanvas({x: 17, y: 21}, view, canvas);
  const back = toMap(there, view, canvas);
  expect(back.x).toBeCloseTo(17, 9);
  expect(back.y).toBeCloseTo(21, 9);
});

test('the map begins at a whole pixel of the canvas, wherever the view is', () => {
  for (const x of [0, 0.25, 100.7, 333.333]) expect(Number.isInteger(originOf({x, y: x / 3, zoom: 1}, canvas).x)).toBe(true);
});

test('the whole map fits, and its middle is that of the canvas', () => {
  const view = fitted({width: 4928, height: 3264}, canvas);
  expect(view).toEqual({x: 2464, y: 1632, zoom: 1001 / 4928});
  expect(3264 * view.zoom).toBeLessThanOrEqual(canvas.height);
});

test('what lies under the pointer stays there when one goes nearer', () => {
  const at = {x: 640, y: 90};
  const view = {x: 500, y: 400, zoom: 0.7};
  const before = toMap(at, view, canvas);
  const after = toMap(at, zoomed(view, 3, at, canvas), canvas);
  expect(Math.abs(after.x - before.x)).toBeLessThan(1 / 0.7);
  expect(Math.abs(after.y - before.y)).toBeLessThan(1 / 0.7);
});

test('a hand that pulls the map to the right shows what is to the left', () => {
  expect(panned({x: 100, y: 100, zoom: 2}, {x: 30, y: -10})).toEqual({x: 85, y: 105, zoom: 2});
});

test('zooming by keys meets the powers of two', () => {
  expect([0.3, 0.5, 1, 1.5].map((zoom) => nextZoom(zoom, 1))).toEqual([0.5, 1, 2, 2]);
  expect([0.3, 0.5, 1, 1.5].map((zoom) => nextZoom(zoom, -1))).toEqual([0.25, 0.25, 0.5, 1]);
});

test('a view never loses the map', () => {
  const map = {width: 4000, height: 3000};
  expect(held({x: -50, y: 9000, zoom: 1000}, map, canvas)).toEqual({x: 0, y: 3000, zoom: 32});
  const far = held({x: 0, y: 0, zoom: 1e-9}, map, canvas);
  expect(far.zoom).toBeCloseTo(fitted(map, canvas).zoom / 4, 9);
});
