// SPDX-License-Identifier: Apache-2.0
// What was measured of the rig over time, as series to plot.
import {fieldsOf, listIn, numberIn, textIn, textsIn} from '../../ui/fields';
import type {CheckResult} from './walk';

export interface CalibrationHistory {
  summary: string;
  calibrations: DatedCalibration[];
  checks: CheckResult[];
  affected: Affected[];
  /** What scanning on would have cost, by scan. */
  costs: Dated[];
  warnings: string[];
}

export interface DatedCalibration {
  measured: string;
  folder: string;
  leds: Led[];
  cameraHeight_mm: number | null;
}

export interface Led {
  led: number;
  position_mm: number[];
  /** Green. */
  flux: number | null;
}

/** A session that a move may have spoiled. */
export interface Affected {
  session: string;
  time: string;
  /** What it shows itself; empty: nobody looked. */
  says: string;
  /** The calibration of now explains it better. */
  isConcerned: boolean;
  mean_deg: number | null;
}

export const noHistory: CalibrationHistory = {summary: '', calibrations: [], checks: [], affected: [], costs: [], warnings: []};

export function historyOf(document: unknown): CalibrationHistory {
  const numbers = fieldsOf(document)['numbers'];
  return {
    summary: textIn(document, 'summary'),
    calibrations: listIn(numbers, 'calibrations').map(calibrationOf),
    checks: listIn(numbers, 'checks').map(checkOf),
    affected: listIn(numbers, 'affected').map(affectedOf),
    costs: listIn(numbers, 'looks').flatMap((look) => datedOf(textIn(look, 'taken'), numberIn(look, 'cost_mean_deg'))),
    warnings: textsIn(document, 'warnings'),
  };
}

function calibrationOf(document: unknown): DatedCalibration {
  return {
    measured: textIn(document, 'measured'),
    folder: textIn(document, 'folder'),
    leds: listIn(document, 'leds').map(ledOf),
    cameraHeight_mm: numberIn(document, 'camera_height_mm'),
  };
}

function ledOf(document: unknown): Led {
  const numbers = (key: string) => listIn(document, key).filter((value) => typeof value === 'number');
  return {led: numberIn(document, 'led') ?? 0, position_mm: numbers('position_mm'), flux: numbers('flux_rgb')[1] ?? null};
}

function checkOf(document: unknown): CheckResult {
  return {
    folder: textIn(document, 'folder'),
    date: textIn(document, 'date'),
    calibration: textIn(document, 'calibration'),
    passed: fieldsOf(document)['passed'] === true,
    found: textIn(document, 'found'),
  };
}

function affectedOf(document: unknown): Affected {
  const folder = textIn(document, 'session');
  return {
    session: folder.slice(folder.lastIndexOf('/') + 1).replace(/\.weft$/, ''),
    time: textIn(document, 'time'),
    says: textIn(document, 'says'),
    isConcerned: fieldsOf(document)['concerned'] === true,
    mean_deg: numberIn(document, 'predicted_mean_deg'),
  };
}

export interface Dated {
  time_ms: number;
  value: number;
}

export interface Series {
  name: string;
  points: Dated[];
}

export function seriesOfCamera(history: CalibrationHistory): Series[] {
  return [{name: '', points: pointsOf(history.calibrations, (each) => each.cameraHeight_mm)}];
}

/** By LED, how far it is from where it was first. */
export function seriesOfPlaces(history: CalibrationHistory): Series[] {
  return seriesOfLeds(history, (led, first) => Math.hypot(...led.position_mm.map((at, axis) => at - (first.position_mm[axis] ?? at))));
}

/** By LED, its light of its first, percent. */
export function seriesOfFluxes(history: CalibrationHistory): Series[] {
  return seriesOfLeds(history, (led, first) => (led.flux === null || first.flux === null ? null : (100 * led.flux) / first.flux));
}

function seriesOfLeds({calibrations}: CalibrationHistory, valueOf: (led: Led, first: Led) => number | null): Series[] {
  const firsts = calibrations.find((each) => each.leds.length > 0)?.leds ?? [];
  return firsts.map((first) => ({
    name: `LED ${first.led}`,
    points: pointsOf(calibrations, (each) => {
      const led = each.leds.find((other) => other.led === first.led);
      return led ? valueOf(led, first) : null;
    }),
  }));
}

function pointsOf(calibrations: readonly DatedCalibration[], valueOf: (each: DatedCalibration) => number | null): Dated[] {
  return calibrations.flatMap((each) => datedOf(each.measured, valueOf(each)));
}

function datedOf(time: string, value: number | null): Dated[] {
  const time_ms = Date.parse(time);
  return value === null || Number.isNaN(time_ms) ? [] : [{time_ms, value}];
}

export interface Label {
  text: string;
  x: number;
  y: number;
}

const line_px = 10;

/** Labels that would lie over each other stand side by side, where the highest of them is. */
export function sideBySide(labels: readonly Label[]): Label[] {
  const lines: Label[] = [];
  for (const label of [...labels].sort((a, b) => a.y - b.y)) {
    const above = lines.at(-1);
    if (above && label.y - above.y < line_px) above.text += ` ${label.text}`;
    else lines.push({...label});
  }
  return lines;
}
