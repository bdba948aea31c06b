// SPDX-License-Identifier: Apache-2.0
import type {Schemas} from '../../api/client';
import {cornerOf, tilesIn, type Point} from './loupe_tiles';

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
