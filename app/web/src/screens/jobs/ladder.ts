// SPDX-License-Identifier: Apache-2.0
// What each level of the solver would cost and give, as a job `price` found out.
import {fieldsOf, listIn, numberIn, textIn} from '../../ui/fields';

/** The levels, the quickest first. */
export const qualities = ['preview', 'fast', 'standard', 'robust', 'reference'] as const;
export type Quality = (typeof qualities)[number];

export interface Level {
  quality: Quality;
  predicted_deg: number;
  parts_deg: {noise: number; model: number; calibration: number};
  seconds: number;
  note: string;
}


export function levelsIn(result: unknown): Level[] {
  return listIn(result, 'levels').flatMap((each) => levelOf(each) ?? []);
}

function levelOf(document: unknown): Level | null {
  const quality = textIn(document, 'quality');
  const predicted_deg = numberIn(document, 'predicted_deg');
  const seconds = numberIn(fieldsOf(document)['seconds'], 'total');
  if (!isQuality(quality) || predicted_deg === null || seconds === null) return null;
  const parts = fieldsOf(document)['parts_deg'];
  const part = (name: string) => numberIn(parts, name) ?? 0;
  return {
    quality,
    predicted_deg,
    parts_deg: {noise: part('noise'), model: part('model'), calibration: part('calibration')},
    seconds,
    note: textIn(document, 'note'),
  };
}

function isQuality(text: string): text is Quality {
  return (qualities as readonly string[]).includes(text);
}

/** Levels that nothing cheaper equals: what a person chooses among. */
export function worthwhile(levels: readonly Level[]): Level[] {
  return levels.filter(
    (level) =>
      !levels.some(
        (other) => other.seconds < level.seconds && other.predicted_deg <= level.predicted_deg,
      ),
  );
}
