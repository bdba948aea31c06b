// SPDX-License-Identifier: Apache-2.0
// How large a cloth is on the canvas: one truth of millimetres, whatever it is laid on.
import type {Size} from '../../gl/view';
import type {MaterialSight} from './material_sight';

export interface ClothExtent {
  /** One piece, however often it is laid beside itself. */
  size_mm: [number, number];
  /** False: nobody knows its millimetres, and `size_mm` tells its proportions alone. */
  is_known: boolean;
  /** Its borders fit, so that it may be laid beside itself. */
  repeats: boolean;
}

export interface Laid {
  px_per_mm: number;
  /** Pieces a side; null: without end. */
  cells: number | null;
  radius_mm: number;
  slant_deg: number;
}

const MARGIN = 0.94;

/**
 * `canvas` in pixels of the page, `screen` the millimetres' pixels there. One piece that does not repeat is laid on the
 * ball whose half it covers: laid from the middle outwards, lengths towards the edge stay true.
 */
export function laidOut(cloth: ClothExtent, sight: MaterialSight, canvas: Size, screen_px_per_mm: number): Laid {
  const [width, height] = cloth.size_mm;
  if (sight.shape === 'true' && cloth.is_known) return {px_per_mm: screen_px_per_mm, cells: cloth.repeats ? null : 1, radius_mm: 0, slant_deg: 0};
  if (sight.shape === 'plane') {
    const cells = cloth.repeats ? sight.repeat : 1;
    const px_per_mm = (MARGIN * Math.min(canvas.width / width, canvas.height / height)) / cells;
    return {px_per_mm, cells, radius_mm: 0, slant_deg: sight.lean_deg};
  }
  const radius_mm = cloth.repeats && cloth.is_known ? sight.ball_mm / 2 : Math.min(width, height) / Math.PI;
  return {px_per_mm: (MARGIN * Math.min(canvas.width, canvas.height)) / (2 * radius_mm), cells: cloth.repeats ? null : 1, radius_mm, slant_deg: 0};
}
