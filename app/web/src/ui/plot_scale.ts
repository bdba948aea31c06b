// SPDX-License-Identifier: Apache-2.0
// Where values lie along an axis, and which of them are written beside it.

export interface Scale {
  /** Share of the axis, 0 at its begin. */
  place(value: number): number;
  ticks: number[];
}

const wantedTicks = 4;

/** A scale over all values, from a round number to a round number, over `leastSpan` at least. */
export function linearScale(values: readonly number[], leastSpan = 1e-9): Scale {
  const least = Math.min(...values);
  const most = Math.max(...values);
  const beside = Math.max(0, leastSpan - (most - least)) / 2;
  const step = roundStep((most - least + 2 * beside) / wantedTicks);
  const begin = Math.floor((least - beside) / step) * step;
  const end = Math.ceil((most + beside) / step) * step;
  const count = Math.round((end - begin) / step);
  const ticks = Array.from({length: count + 1}, (_, i) => rounded(begin + i * step, step));
  return {place: (value) => (value - begin) / (end - begin), ticks};
}

/** A logarithmic scale over positive values, with a tick at 1, 2 and 5 of each decade. */
export function logScale(values: number[]): Scale {
  const begin = Math.log10(below(Math.min(...values)));
  const end = Math.log10(above(Math.max(...values)));
  const ticks = [];
  for (let decade = Math.floor(begin); decade <= Math.ceil(end); ++decade) {
    for (const digit of [1, 2, 5]) {
      const tick = Number(`${digit}e${decade}`);
      if (isWithin(Math.log10(tick), begin, end)) ticks.push(tick);
    }
  }
  return {place: (value) => (Math.log10(value) - begin) / (end - begin), ticks};
}

/** For names of one width beside points: in which lane each is, so that none lies over another. */
export function lanesOf<T>(things: readonly T[], placeOf: (thing: T) => number, width: number): Map<T, number> {
  const ends: number[] = [];
  const lanes = new Map<T, number>();
  for (const thing of [...things].sort((a, b) => placeOf(a) - placeOf(b))) {
    const begin = placeOf(thing) - width / 2;
    const free = ends.findIndex((end) => end <= begin);
    const lane = free < 0 ? ends.length : free;
    ends[lane] = begin + width;
    lanes.set(thing, lane);
  }
  return lanes;
}

function roundStep(step: number): number {
  const decade = 10 ** Math.floor(Math.log10(step));
  const digit = [1, 2, 5, 10].find((each) => each * decade >= step * (1 - 1e-9)) ?? 10;
  return digit * decade;
}

function rounded(value: number, step: number): number {
  const decimals = Math.max(0, -Math.floor(Math.log10(step)));
  return Number(value.toFixed(decimals));
}

/** The next of 1, 2, 5, 10, ... that is clearly below, so that no point lies on the frame. */
function below(value: number): number {
  const decade = 10 ** Math.floor(Math.log10(value));
  const digit = [5, 2, 1].find((each) => each * decade < value * 0.9);
  return digit === undefined ? decade / 2 : digit * decade;
}

function above(value: number): number {
  const decade = 10 ** Math.floor(Math.log10(value));
  const digit = [1, 2, 5, 10].find((each) => each * decade > value * 1.1) ?? 20;
  return digit * decade;
}

function isWithin(value: number, begin: number, end: number): boolean {
  const tolerance = 1e-9;
  return value >= begin - tolerance && value <= end + tolerance;
}
