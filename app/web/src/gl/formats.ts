// SPDX-License-Identifier: Apache-2.0
// How the daemon writes tiles for programs (docs/reference/calls.md, solves), and what WebGL is told of them.
import type {Size} from './view';

/** normal: RGB10_A2 with 1022 steps; color: three half floats; scalar: one; flags: a byte. */
export type TileKind = 'normal' | 'color' | 'scalar' | 'flags';

const bytesPerPixel: Record<TileKind, number> = {normal: 4, color: 6, scalar: 2, flags: 1};

export function tileBytes(kind: TileKind, size: Size): number {
  return bytesPerPixel[kind] * size.width * size.height;
}
