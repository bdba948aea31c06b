// SPDX-License-Identifier: Apache-2.0
// How a map is cut into tiles, and which of them a view needs.
import {type Box, type Point, type Size, type View, clamp, originOf, toMap} from './view';

/** Level 0 is the map, each next level has half its sides, odd ones rounded up. The last is small on any line. */
export interface Pyramid {
  size: Size;
  side: number;
  levels: number;
  /** Where it lies, once, on the map that is seen; none: it is that map. */
  at?: Point;
}

export interface Tile {
  level: number;
  column: number;
  row: number;
}

export function levelSize(pyramid: Pyramid, level: number): Size {
  const halved = (side: number) => Math.ceil(side / 2 ** level);
  return {width: halved(pyramid.size.width), height: halved(pyramid.size.height)};
}

/** Pixels of a tile: those at the right and lower edge have fewer. */
export function tileSize(pyramid: Pyramid, tile: Tile): Size {
  const whole = levelSize(pyramid, tile.level);
  return {
    width: Math.min(pyramid.side, whole.width - tile.column * pyramid.side),
    height: Math.min(pyramid.side, whole.height - tile.row * pyramid.side),
  };
}

/** What a tile covers, in pixels of the map. At odd edges it reaches a little beyond. */
export function tileBox(pyramid: Pyramid, tile: Tile): Box {
  const each = 2 ** tile.level;
  const size = tileSize(pyramid, tile);
  return {
    x: tile.column * pyramid.side * each,
    y: tile.row * pyramid.side * each,
    width: size.width * each,
    height: size.height * each,
  };
}

/** The coarsest level that has a pixel for each of the canvas. */
export function levelFor(pyramid: Pyramid, zoom: number): number {
  return clamp(Math.floor(-Math.log2(zoom) + 1e-6), 0, pyramid.levels - 1);
}

/** Tiles of a level that the canvas shows of a map which lies at `offset`, in no order. */
function tilesAt(pyramid: Pyramid, level: number, view: View, canvas: Size, offset: Point): Tile[] {
  const step = pyramid.side * 2 ** level;
  const whole = levelSize(pyramid, level);
  const begin = toMap({x: 0, y: 0}, view, canvas);
  const end = toMap({x: canvas.width, y: canvas.height}, view, canvas);
  const columns = Math.ceil(whole.width / pyramid.side);
  const rows = Math.ceil(whole.height / pyramid.side);
  const tiles: Tile[] = [];
  const first = (from: number) => Math.max(0, Math.floor(from / step));
  const last = (to: number, count: number) => Math.min(count, Math.ceil(to / step));
  for (let row = first(begin.y - offset.y); row < last(end.y - offset.y, rows); ++row) {
    for (let column = first(begin.x - offset.x); column < last(end.x - offset.x, columns); ++column) {
      tiles.push({level, column, row});
    }
  }
  return tiles;
}

function distance(pyramid: Pyramid, tile: Tile, from: Point): number {
  const box = tileBox(pyramid, tile);
  return Math.hypot(box.x + box.width / 2 - from.x, box.y + box.height / 2 - from.y);
}

/** Tiles of a level in view, those nearest the middle first, each once however often the map is repeated. */
export function tilesInView(pyramid: Pyramid, level: number, view: View, canvas: Size, offsets: Point[]): Tile[] {
  const nearest = new Map<string, {tile: Tile; far: number}>();
  for (const offset of offsets) {
    for (const tile of tilesAt(pyramid, level, view, canvas, offset)) {
      const name = `${tile.column}_${tile.row}`;
      const far = distance(pyramid, tile, {x: view.x - offset.x, y: view.y - offset.y});
      if (far < (nearest.get(name)?.far ?? Infinity)) nearest.set(name, {tile, far});
    }
  }
  return [...nearest.values()].sort((a, b) => a.far - b.far).map(({tile}) => tile);
}

/** How often a map is seen a side. */
export type Repeat = 1 | 2 | 3;

const stepsOf: Record<Repeat, number[]> = {1: [0], 2: [0, 1], 3: [-1, 0, 1]};

/** Where maps lie that are repeated `count` times a side, of three around the first, which stays at 0, 0. */
export function repeats({size, at}: Pick<Pyramid, 'size' | 'at'>, count: Repeat): Point[] {
  if (at) return [at];
  const steps = stepsOf[count];
  return steps.flatMap((row) => steps.map((column) => ({x: column * size.width, y: row * size.height})));
}

/** A box of the map on the canvas, between whole pixels, so that neighbours share their edge. */
export function boxOnCanvas(box: Box, offset: Point, view: View, canvas: Size): Box {
  const origin = originOf(view, canvas);
  const left = Math.round(origin.x + (offset.x + box.x) * view.zoom);
  const top = Math.round(origin.y + (offset.y + box.y) * view.zoom);
  const right = Math.round(origin.x + (offset.x + box.x + box.width) * view.zoom);
  const bottom = Math.round(origin.y + (offset.y + box.y + box.height) * view.zoom);
  return {x: left, y: top, width: right - left, height: bottom - top};
}
