// SPDX-License-Identifier: Apache-2.0
// Which tiles a loupe shows, and where: a photograph comes in disjoint squares.

export const tile = 512;

export interface Point {
  x: number;
  y: number;
}

export interface PlacedTile {
  name: string;
  /** Of its corner, from that of the loupe, in pixels of the photograph. */
  left: number;
  top: number;
}

/** Corner of a window of this size around a place (in shares), kept within the photograph. */
export function cornerOf(place: Point, size: number, width: number, height: number): Point {
  const within = (share: number, extent: number) => Math.round(Math.min(Math.max(share * extent - size / 2, 0), Math.max(extent - size, 0)));
  return {x: within(place.x, width), y: within(place.y, height)};
}

function range(from: number, to: number): number[] {
  return Array.from({length: to - from + 1}, (_, index) => from + index);
}

/** The tiles that a window touches. */
export function tilesIn(corner: Point, size: number, width: number, height: number): PlacedTile[] {
  const last = (at: number, extent: number) => Math.floor((Math.min(at + size, extent) - 1) / tile);
  const columns = range(Math.floor(corner.x / tile), last(corner.x, width));
  const rows = range(Math.floor(corner.y / tile), last(corner.y, height));
  return rows.flatMap((row) => columns.map((column) => ({name: `${column}_${row}`, left: column * tile - corner.x, top: row * tile - corner.y})));
}
