// SPDX-License-Identifier: Apache-2.0
// What the daemon says of a pixel, a rectangle and a line.
import type {Schemas} from '../../api/client';

/** What the solve made of one light's reading. Of a light that was left out as a whole only the last two are there. */
export interface Reading {
  led: number;
  counts?: number | null;
  reading?: number | null;
  model?: number | null;
  sigma?: number | null;
  residual_sigma?: number | null;
  light_dir?: [number, number, number];
  used: boolean;
  left_out: string | null;
}

export interface Readings {
  channel: string | null;
  counts_dark: number | null;
  readings: Reading[];
}

export type PixelFacts = Schemas['PixelFacts'];

export function readingsOf(pixel: PixelFacts): Readings | null {
  return pixel.readings as Readings | null;
}

/** By layer its values; of status the names of its bits. */
export function valuesOf(pixel: PixelFacts, layer: string): readonly (number | string)[] {
  return (pixel.maps as Record<string, (number | string)[]>)[layer] ?? [];
}

export interface ChannelFacts {
  mean: number;
  deviation: number;
  p5: number;
  p50: number;
  p95: number;
  least: number;
  most: number;
  bins: number[];
}

export type RegionFacts = Schemas['RegionFacts'];

/** By channel the figures of a layer; null where no pixel has a value. */
export function channelsOf(region: RegionFacts, layer: string): Record<string, ChannelFacts | null> {
  return (region.layers as Record<string, Record<string, ChannelFacts | null>>)[layer] ?? {};
}

export function sharesOf(region: RegionFacts): Record<string, number> {
  return region.status as Record<string, number>;
}

const reasons: Record<string, string> = {
  saturated: 'too bright',
  missing: 'missing',
  shadowed: 'shadowed',
  rejected: 'does not fit',
  'not lit': 'not lit',
  moved: 'the cloth moved',
};

export function reasonOf(reading: Reading): string {
  return reading.left_out === null ? '' : (reasons[reading.left_out] ?? reading.left_out);
}
