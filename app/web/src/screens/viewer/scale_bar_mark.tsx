// SPDX-License-Identifier: Apache-2.0
import {scaleBar, zoomInWords} from './bars';
import type {Viewer} from './viewer';

const MOST_PX = 160;

/** A length on the cloth, true in the middle of the frame. */
export function ScaleBarMark({viewer, density}: {viewer: Viewer; density: number}) {
  const maps = viewer.maps.value;
  const view = viewer.view.value;
  if (!maps || !view) return null;
  const bar = scaleBar(maps.solve.mm_per_pixel, view.zoom, MOST_PX * density);
  return (
    <div class="scale-bar numbers">
      <span class="length" style={{width: `${bar.length / density}px`}} />
      {bar.says} <span class="dim">{zoomInWords(view.zoom)}</span>
    </div>
  );
}
