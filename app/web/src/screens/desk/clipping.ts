// SPDX-License-Identifier: Apache-2.0
// How much room is left above a photograph's brightest places: words for the daemon's histogram.
import type {Schemas} from '../../api/client';
import type {Verdict} from '../../ui/mark';

type Histogram = Schemas['Histogram'];

export interface Exposed {
  verdict: Verdict;
  word: 'good' | 'near' | 'over' | 'dark';
  /** Share of the worst channel at or above white. */
  clipped: number;
  /** Stops from the brightest thousandth to white; null: over. */
  headroom_stops: number | null;
}

const nearFrom = 0.001;
const overFrom = 0.01;
const darkBelow = 0.1;
const brightest = 0.001;

/** Upper edge of the bin that holds the brightest thousandth: a share of the way from black to white. */
export function highlightOf(bins: readonly number[]): number {
  const total = bins.reduce((sum, count) => sum + count, 0);
  let above = 0;
  for (let bin = bins.length - 1; bin > 0; bin--) {
    above += bins[bin] ?? 0;
    if (above > total * brightest) return (bin + 1) / bins.length;
  }
  return 1 / bins.length;
}

export function exposedOf({red, green, blue}: Histogram): Exposed {
  const channels = [red, green, blue];
  const clipped = Math.max(...channels.map((channel) => channel.clipped));
  const highlight = Math.max(...channels.map((channel) => highlightOf(channel.bins)));
  if (clipped >= overFrom) return {verdict: 'fault', word: 'over', clipped, headroom_stops: null};
  const headroom_stops = Math.log2(1 / highlight);
  if (clipped >= nearFrom) return {verdict: 'warning', word: 'near', clipped, headroom_stops};
  if (highlight < darkBelow) return {verdict: 'warning', word: 'dark', clipped, headroom_stops};
  return {verdict: 'fine', word: 'good', clipped, headroom_stops};
}

/** What to expose with so that nothing is over: two stops less, or as near to it as a ratio was measured. */
export function lessThan(exposure_us: number, measured_us: readonly number[]): number {
  const wanted_us = exposure_us / 4;
  const stopsOff = (time_us: number) => Math.abs(Math.log2(time_us / wanted_us));
  const [nearest] = measured_us.filter((time_us) => time_us < exposure_us).sort((a, b) => stopsOff(a) - stopsOff(b));
  return nearest ?? wanted_us;
}
