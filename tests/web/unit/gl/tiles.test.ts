// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {boxOnCanvas, levelFor, levelSize, type Pyramid, repeats, tileBox, tileSize, tilesInView} from '../../../../app/web/src/gl/tiles';

const pyramid: Pyramid = {size: {width: 4929, height: 3263}, side: 512, levels: 5};
const canvas = {width: 1280, height: 720};
const here = [{x: 0, y: 0}];

test('levels halve both sides and round odd ones up', () => {
  expect(levelSize(pyramid, 1)).toEqual({width: 2465, height: 1632});
  expect(levelSize(pyramid, 4)).toEqual({width: 309, height: 204});
});

test('tiles at the right and lower edge are what is left', () => {
  expect(tileSize(pyramid, {level: 0, column: 9, row: 6})).toEqual({width: 321, height: 191});
  expect(tileBox(pyramid, {level: 1, column: 4, row: 3})).toEqual({x: 4096, y: 3072, width: 834, height: 192});
});

test('the level has at least a pixel for each of the canvas, and no more than four', () => {
  expect([1, 3, 0.51, 0.5, 0.3, 0.25, 0.001].map((zoom) => levelFor(pyramid, zoom))).toEqual([0, 0, 0, 1, 1, 2, 4]);
});

test('tiles of a view cover it, and the middle comes first', () => {
  const view = {x: 2464, y: 1632, zoom: 1};
  const tiles = tilesInView(pyramid, 0, view, canvas, here);
  const boxes = tiles.map((tile) => tileBox(pyramid, tile));
  expect(Math.min(...boxes.map(({x}) => x))).toBeLessThanOrEqual(2464 - 640);
  expect(Math.max(...boxes.map(({x, width}) => x + width))).toBeGreaterThanOrEqual(2464 + 640);
  expect(Math.min(...boxes.map(({y}) => y))).toBeLessThanOrEqual(1632 - 360);
  expect(Math.max(...boxes.map(({y, height}) => y + height))).toBeGreaterThanOrEqual(1632 + 360);
  const far = boxes.map((box) => Math.hypot(box.x + box.width / 2 - view.x, box.y + box.height / 2 - view.y));
  expect(far).toEqual([...far].sort((a, b) => a - b));
  expect(tiles.length).toBe(8);
});

test('no tile is wanted of what lies beyond the map', () => {
  expect(tilesInView(pyramid, 0, {x: -3000, y: 0, zoom: 1}, canvas, here)).toEqual([]);
  expect(tilesInView(pyramid, 4, {x: 2464, y: 1632, zoom: 0.01}, canvas, here)).toEqual([{level: 4, column: 0, row: 0}]);
});

test('a map that is repeated asks for each tile once', () => {
  const small: Pyramid = {size: {width: 600, height: 400}, side: 512, levels: 2};
  const offsets = repeats(small, 3);
  expect(offsets.length).toBe(9);
  const tiles = tilesInView(small, 0, {x: 300, y: 200, zoom: 1}, canvas, offsets);
  expect(tiles.map(({column, row}) => `${column}_${row}`).sort()).toEqual(['0_0', '1_0']);
});

test('a map that lies on another is seen once, where it lies', () => {
  expect(repeats({size: {width: 600, height: 400}, at: {x: -20, y: 30}}, 2)).toEqual([{x: -20, y: 30}]);
});

test('neighbours share their edge on the canvas at any zoom', () => {
  for (const zoom of [0.13, 0.25, 0.7, 1.3, 8]) {
    const view = {x: 1000.3, y: 700.7, zoom};
    const [left, right] = [0, 1].map((column) => boxOnCanvas(tileBox(pyramid, {level: 1, column, row: 0}), {x: 0, y: 0}, view, canvas));
    expect(left!.x + left!.width).toBe(right!.x);
  }
});
