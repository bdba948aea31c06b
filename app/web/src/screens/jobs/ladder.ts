// SPDX-License-Identifier: Apache-2.0
// What each level of the solver would cost and give, as a job `price` found out.
import type {Quality} from '../../state/forms';
import {fieldsOf, listIn, numberIn, textIn} from '../../ui/fields';

export interface Level {
  quality: Quality;
  predicted_deg: number;
  /** Share of the cloth that it holds for: the rest has no normal. */
  solved: number;
  parts_deg: {noise: number; model: number; calibration: number};
  seconds: number;
  note: string;
}

export function levelsIn(result: unknown): Level[] {
  return listIn(result, 'levels').flatMap((each) => levelOf(each) ?? []);
}

function levelOf(document: unknown): Level | null {
  const quality = textIn(document, 'quality') as Quality;
  const predicted_deg = numberIn(document, 'predicted_deg');
  const seconds = numberIn(fieldsOf(document)['seconds'], 'total');
  if (String(quality) === '' || predicted_deg === null || seconds === null) return null;
  const parts = fieldsOf(document)['parts_deg'];
  const part = (name: string) => numberIn(parts, name) ?? 0;
  return {
    quality,
    predicted_deg,
    solved: numberIn(document, 'solved') ?? 1,
    parts_deg: {noise: part('noise'), model: part('model'), calibration: part('calibration')},
    seconds,
    note: textIn(document, 'note'),
  };
}

/** Cloth of which less has a normal is not solved; as the command line has it. */
const leastSolved = 0.5;
/** What straight up is off from a normal that nobody knows, on the mean. */
const unknown_deg = 180 / Math.PI;

function degOfWhole({predicted_deg, solved}: Level): number {
  return solved * predicted_deg + (1 - solved) * unknown_deg;
}

/** Levels that solve the cloth and that nothing cheaper equals: what a person chooses among. */
export function worthwhile(levels: readonly Level[]): Level[] {
  return levels.filter(
    (level) =>
      level.solved >= leastSolved &&
      !levels.some((other) => other.seconds < level.seconds && degOfWhole(other) <= degOfWhole(level)),
  );
}

/** Levels that can stand on logarithmic axes: an error of nothing is none. */
export function drawable(levels: readonly Level[]): Level[] {
  return levels.filter(({solved, predicted_deg}) => solved > 0 && predicted_deg > 0);
}
