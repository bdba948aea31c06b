// SPDX-License-Identifier: Apache-2.0
// Counts, angles and ages as people say them.
import {percentOf} from './words';

const minute_s = 60;
const hour_s = 60 * minute_s;
const day_s = 24 * hour_s;

export function counted(count: number, one: string, many = `${one}s`): string {
  return `${count} ${count === 1 ? one : many}`;
}

/** Two digits that matter: 0.0034, 0.41, 3.1, 41. */
export function digits(value: number, significant = 2): string {
  if (value === 0 || !Number.isFinite(value)) return String(value);
  const decimals = Math.max(0, significant - 1 - Math.floor(Math.log10(Math.abs(value))));
  return value.toFixed(Math.min(decimals, 6));
}

export function degrees(value: number): string {
  return `${digits(value)}°`;
}

/** An error never stands without the share of the cloth that it holds for. */
export function degreesOn(value: number, solved: number): string {
  if (solved <= 0) return 'nothing solved';
  return `${degrees(value)} on ${solved < 1 && solved >= 0.995 ? 'over 99 %' : percentOf(solved)}`;
}

/** An exposure as cameras say it: 1/250 s, 0.4 s. */
export function shutter(us: number): string {
  const duration_s = us / 1e6;
  return duration_s < 0.3 ? `1/${Math.round(1 / duration_s)} s` : `${digits(duration_s)} s`;
}

/** How long ago a time of ISO 8601 was. */
export function age(iso: string, now_ms: number = Date.now()): string {
  const then_ms = Date.parse(iso);
  if (Number.isNaN(then_ms)) return '';
  const past_s = Math.max(0, (now_ms - then_ms) / 1000);
  if (past_s < minute_s) return 'just now';
  if (past_s < hour_s) return `${counted(Math.floor(past_s / minute_s), 'minute')} ago`;
  if (past_s < day_s) return `${counted(Math.floor(past_s / hour_s), 'hour')} ago`;
  return `${counted(Math.floor(past_s / day_s), 'day')} ago`;
}
