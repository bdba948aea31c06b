// SPDX-License-Identifier: Apache-2.0
// The daemon's bill of a scan in words.
import type {Schemas} from '../../api/client';
import {counted, degrees} from '../../ui/say';
import {durationOf} from '../../ui/words';

export type BillLine = Schemas['BillLine'];

function costInWords(shots: number, seconds: number | null): string {
  return counted(shots, 'shot') + (seconds === null ? '' : `, ${durationOf(seconds)}`);
}

export function costOf({shots, seconds}: BillLine): string {
  return costInWords(shots, seconds);
}

/** Of the whole scan; without a time where that of some shots is not known. */
export function totalOf(bill: readonly BillLine[]): string {
  const shots = bill.reduce((sum, line) => sum + line.shots, 0);
  const seconds = bill.reduce<number | null>((sum, line) => (sum === null || line.seconds === null ? null : sum + line.seconds), 0);
  return costInWords(shots, seconds);
}

/** "0.40° without, 0.0013° with"; null where nobody measured it. */
export function gainOf({without_deg, with_deg}: BillLine): string | null {
  if (without_deg === null || with_deg === null) return null;
  return `${degrees(without_deg)} without, ${degrees(with_deg)} with`;
}
