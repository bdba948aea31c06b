// SPDX-License-Identifier: Apache-2.0
// Jobs as people read them: what runs, what waits in its order, what ended.
import type {Schemas} from '../../api/client';

export type Job = Schemas['Job'];
export type JobEvent = Schemas['JobEvent'];

export interface Queue {
  running: Job[];
  waiting: Job[];
  ended: Job[];
}

/** What was asked of it beside its kind: the level, a limit, another calibration. */
export function wishOf({wants}: Job): string {
  const {quality, method, within_s, to_deg, calibration, cloth, preview, recipe, presets, sessions} = wants;
  return [
    quality ?? method ?? cloth,
    within_s === undefined ? undefined : `within ${within_s} s`,
    to_deg === undefined ? undefined : `to ${to_deg}°`,
    sessions === undefined ? undefined : `${sessions} sessions`,
    recipe,
    Array.isArray(presets) ? presets.join(', ') : undefined,
    preview ? 'preview' : undefined,
    calibration === undefined ? undefined : `by ${calibration}`,
  ].filter((word) => word !== undefined).join(', ');
}

/** From a list with the newest first. */
export function queueOf(jobs: readonly Job[]): Queue {
  const in_state = (state: Job['state']) => jobs.filter((job) => job.state === state);
  return {
    running: in_state('running'),
    waiting: in_state('queued').sort((a, b) => placeOf(a) - placeOf(b)),
    ended: jobs.filter(hasEnded),
  };
}

/** How many wait before it; where that is not said, the order in which they were asked for. */
function placeOf(job: Job): number {
  return job.place ?? Number(job.id);
}

export function hasEnded(job: {state: Job['state']}): boolean {
  return job.state !== 'queued' && job.state !== 'running';
}

/** The list after an event: what that does not bring stays as it was. */
export function withEvent(jobs: readonly Job[], event: JobEvent): Job[] {
  const known = jobs.find((job) => job.id === event.id);
  const job: Job = {place: null, notes: [], result: null, ...known, ...event};
  return known ? jobs.map((each) => (each.id === event.id ? job : each)) : [job, ...jobs];
}

/** Both lists, the newer document of each job, the newest job first. */
export function merged(old: readonly Job[], newer: readonly Job[]): Job[] {
  const by_id = new Map([...old, ...newer].map((job) => [job.id, job]));
  return [...by_id.values()].sort((a, b) => b.id.localeCompare(a.id));
}

/** One sentence of how it is. */
export function stateOf(job: Job): string {
  if (job.held) return 'stands still until the scan has ended';
  if (job.state === 'queued') return 'waits';
  if (job.state === 'running') return job.phase || 'begins';
  if (job.state === 'done' && job.exit_code) return 'done, with findings';
  return job.state;
}
