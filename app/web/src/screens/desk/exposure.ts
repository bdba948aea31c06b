// SPDX-License-Identifier: Apache-2.0
// What a person types as an exposure, held against the times that the camera has.
import {shutter} from '../../ui/say';

export interface Chosen {
  /** null: the cloth is metered, or what is typed cannot be used. */
  exposure_us: number | null;
  /** What becomes of what is typed; empty: there is nothing to say. */
  says: string;
  isWrong: boolean;
}

const perUnit_us: Record<string, number> = {us: 1, µs: 1, ms: 1e3, s: 1e6};
/** What is listed as 16.7 ms is 1/60 s. */
const sameTime = 0.01;
/** Half of a camera's step: what is farther beyond its ends is another time. */
const beyond = 2 ** (1 / 6);

/** "16.7", "16,7 ms", "1/60", "0.5 s" in microseconds; null: it is none. A fraction is of a second. */
export function exposureIn(text: string): number | null {
  const [, number, over, unit] = /^(\d*[.,]?\d+|\d+[.,])(?:\s*\/\s*(\d+))?\s*(us|µs|ms|s)?$/.exec(text.trim()) ?? [];
  if (number === undefined) return null;
  const value = Number(number.replace(',', '.')) / Number(over ?? 1);
  const us = value * (perUnit_us[unit ?? (over ? 's' : 'ms')] ?? 0);
  return us > 0 && Number.isFinite(us) ? us : null;
}

/** As the field has it: milliseconds. */
export function millisecondsOf(us: number): string {
  return String(Number((us / 1000).toPrecision(us < 1e6 ? 3 : 5)));
}

/** "12.5 ms (1/80 s)", "400 ms", "1.6 s". */
export function exposureInWords(us: number): string {
  if (us >= 1e6) return `${Number((us / 1e6).toPrecision(3))} s`;
  return `${millisecondsOf(us)} ms${us < 300_000 ? ` (${shutter(us)})` : ''}`;
}

function nearestOf(times_us: readonly number[], wanted_us: number): number {
  const off = (us: number) => Math.abs(Math.log(us / wanted_us));
  return times_us.reduce((nearest, us) => (off(us) < off(nearest) ? us : nearest));
}

/** The camera's own time (of those that rise here; none: they are not known yet) that is meant by a text. */
export function chosenIn(text: string, times_us: readonly number[]): Chosen {
  if (text.trim() === '') return {exposure_us: null, says: '', isWrong: false};
  const wanted_us = exposureIn(text);
  if (wanted_us === null) return {exposure_us: null, says: 'No exposure: write 16.7 ms, 1/60 or 0.5 s.', isWrong: true};
  const [shortest, longest] = [times_us[0], times_us.at(-1)];
  if (shortest === undefined || longest === undefined) return {exposure_us: wanted_us, says: 'The camera\'s nearest is taken.', isWrong: false};
  if (wanted_us * beyond < shortest || wanted_us > longest * beyond) {
    return {exposure_us: null, says: `The camera has ${exposureInWords(shortest)} to ${exposureInWords(longest)}.`, isWrong: true};
  }
  const exposure_us = nearestOf(times_us, wanted_us);
  const isSame = Math.abs(exposure_us / wanted_us - 1) <= sameTime;
  return {exposure_us, says: isSame ? exposureInWords(exposure_us) : `${exposureInWords(exposure_us)} is the camera's nearest.`, isWrong: false};
}
