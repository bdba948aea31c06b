// SPDX-License-Identifier: Apache-2.0
// What changed, as people read it.
import type {Schemas} from '../../api/client';
import {fieldsOf, numberIn} from '../../ui/fields';
import {counted, degrees, digits} from '../../ui/say';

export type BatchReport = Schemas['BatchReport'];
export type Change = Schemas['BatchChange'];

/** Mean angle, 95th percentile, albedo, sigma of one session. */
export function changeInCells({change}: Pick<Change, 'change'>): string[] {
  const sigma = fieldsOf(change)['sigma_deg'];
  const [before, after] = [numberIn(sigma, 'before'), numberIn(sigma, 'after')];
  const albedo = 100 * (numberIn(change, 'albedo_bias_rel') ?? 0);
  return [
    degrees(numberIn(change, 'mean_deg') ?? 0),
    degrees(numberIn(change, 'p95_deg') ?? 0),
    `${albedo > 0 ? '+' : ''}${digits(albedo)} %`,
    before === null || after === null ? '' : `${degrees(before)} → ${degrees(after)}`,
  ];
}

/** What accepting would do, before it is done. */
export function acceptanceInWords({moved, left}: Pick<Schemas['Acceptance'], 'moved' | 'left'>): string {
  const stay = left === 0 ? 'none stays as it is' : `${counted(left, 'session stays as it is', 'sessions stay as they are')}`;
  return `${counted(moved, 'session gets its new solve', 'sessions get their new solve')} as the current one; ${stay}.`;
}
