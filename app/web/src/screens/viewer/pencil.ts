// SPDX-License-Identifier: Apache-2.0
// Ruler and rectangle by keys: arrows lead a point over the map, Enter sets the begin and then the end.
import {clamp, type Point, toCanvas} from '../../gl/view';
import {measure} from './hand';
import type {Pencil, Viewer} from './viewer';

/** At first in the middle of a pixel in the middle of the view. */
function pencilOf(viewer: Viewer): Pencil {
  const {x, y} = viewer.view.value ?? {x: 0, y: 0};
  return viewer.pencil.value ?? {at: {x: Math.floor(x) + 0.5, y: Math.floor(y) + 0.5}, begin: null};
}

/** A step is a pixel of the map, or a pixel of the canvas where that is farther: one that cannot be seen leads nobody. */
export function lead(viewer: Viewer, by: Point): void {
  const map = viewer.maps.value?.solve;
  const view = viewer.view.value;
  if (!map || !view) return;
  const step = Math.max(1, 1 / view.zoom);
  const {at, begin} = pencilOf(viewer);
  const to = {x: clamp(at.x + step * by.x, 0, map.width), y: clamp(at.y + step * by.y, 0, map.height)};
  viewer.pencil.value = {at: to, begin};
  const canvas = viewer.canvas.value;
  const seen = toCanvas(to, view, canvas);
  const isSeen = seen.x >= 0 && seen.y >= 0 && seen.x <= canvas.width && seen.y <= canvas.height;
  if (!isSeen) viewer.move(({zoom}) => ({...to, zoom}));
  if (begin) measure(viewer, begin, to);
}

export function setEnd(viewer: Viewer): void {
  const {at, begin} = pencilOf(viewer);
  viewer.pencil.value = {at, begin: begin ? null : at};
  if (!begin) measure(viewer, at, at);
}
