// SPDX-License-Identifier: Apache-2.0
// A batch before it is run: what is asked for, and its plan as people read it.
import type {Schemas} from '../../api/client';
import type {Wish} from '../../ui/request_schema';
import {counted} from '../../ui/say';
import {filtersIn, questionOf} from '../sessions/filters';

export type Plan = NonNullable<Schemas['OneBatch']['plan']>;

/** Sessions that are chosen, or all that a search finds. */
export type Scope = {sessions: string[]; calibration?: string} | {find: Record<string, string>};

export const aims = ['level', 'hours', 'degrees'] as const;
export type Aim = (typeof aims)[number];

export interface PlanWish {
  aim: Aim;
  quality: string;
  hours: string;
  degrees: string;
}

export const firstWish: PlanWish = {aim: 'level', quality: 'standard', hours: '8', degrees: '1'};

/** Where a selection is kept for the form, for as long as the tab is open: an address has no room for it. */
export const chosenKey = 'weft-plan';

/** What the address says is to be planned; null: nothing. */
export function scopeIn(query: URLSearchParams): Scope | null {
  const plan = query.get('plan');
  if (plan === 'chosen') return JSON.parse(sessionStorage.getItem(chosenKey) ?? '{"sessions": []}');
  return plan === null ? null : {find: questionOf(filtersIn(query))};
}

export function scopeInWords(scope: Scope): string {
  if ('sessions' in scope) return `${counted(scope.sessions.length, 'chosen session')}${scope.calibration ? ` by ${scope.calibration}` : ''}`;
  const words = Object.entries(scope.find).map(([key, value]) => (key === 'warned' ? 'with warnings' : `${key} ${value}`));
  return words.length ? `all sessions by ${words.join(', ')}` : 'all sessions of the library';
}

function above(text: string): number | null {
  const value = Number(text);
  return text.trim() !== '' && value > 0 && Number.isFinite(value) ? value : null;
}

/** The request; or what is wrong with the wish, as a sentence. */
export function requestOf(scope: Scope, {aim, quality, hours, degrees}: PlanWish, said: Wish = {}): Schemas['BatchPlanJob'] | string {
  const hours_h = above(hours);
  const to_deg = above(degrees);
  if ('sessions' in scope && scope.sessions.length === 0) return 'Choose sessions in the library first.';
  if (aim === 'hours' && hours_h === null) return 'Hours are a number above 0.';
  if (aim === 'degrees' && to_deg === null) return 'Degrees are a number above 0.';
  return {
    kind: 'batch_plan',
    ...scope,
    ...(aim === 'level' && {quality: quality as 'standard'}),
    ...(hours_h !== null && aim === 'hours' && {within_s: hours_h * 3600}),
    ...(to_deg !== null && aim === 'degrees' && {to_deg}),
    ...said,
  };
}

const reasons: Record<string, string> = {
  there: 'have this solve already',
  unsolvable: 'cannot be solved',
  turns_little: 'would turn by less than asked',
  not_good_enough: 'reach no such error at any level',
};

export function reasonInWords(reason: string): string {
  return reasons[reason] ?? reason;
}

interface Point {
  name: string;
  seconds: number;
  mean_deg: number;
}

/** What can stand on logarithmic axes: all sessions at each level. */
export function levelPoints({levels}: Pick<Plan, 'levels'>): Point[] {
  return levels.filter(({seconds, mean_deg}) => seconds > 0 && mean_deg > 0).map(({quality, seconds, mean_deg}) => ({name: quality, seconds, mean_deg}));
}
