// SPDX-License-Identifier: Apache-2.0
// Which rows of a long list are drawn: those in view and a few beyond, never more than `most`.

export interface Viewport {
  top_px: number;
  height_px: number;
}

export interface RowRange {
  first: number;
  end: number;
}

export const mostRows = 60;

export function rowsInView(view: Viewport, row_px: number, count: number, beyond = 8): RowRange {
  const seen = Math.ceil(view.height_px / row_px) + 1;
  const drawn = Math.min(seen + 2 * beyond, mostRows, count);
  const wanted = Math.floor(view.top_px / row_px) - beyond;
  const first = Math.max(0, Math.min(wanted, count - drawn));
  return {first, end: first + drawn};
}
