// SPDX-License-Identifier: Apache-2.0
// A photograph comes in disjoint squares: which of them a loupe shows, and where.
import type {Schemas} from '../../api/client';
import type {Point} from '../../gl/view';

export const tile = 512;

export interface PlacedTile {
  name: string;
  /** Where its corner is from that of the loupe, in pixels of the photograph. */
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

const size = 256;

/** A part of a test shot, one pixel of the photograph to one of the screen. */
export function Loupe({shot, place}: {shot: Schemas['TestShot']; place: Point}) {
  const corner = cornerOf(place, size, shot.width, shot.height);
  return (
    <div class="loupe" role="img" aria-label={`Test shot ${shot.id} pixel by pixel, from ${corner.x}, ${corner.y}`}>
      {tilesIn(corner, size, shot.width, shot.height).map(({name, left, top}) => (
        <img key={name} src={`/api/v1/rig/test-shots/${shot.id}/tiles/0/${name}.jpg`} alt="" style={{left: `${left}px`, top: `${top}px`}} />
      ))}
    </div>
  );
}
