// SPDX-License-Identifier: Apache-2.0
// What a person asks of the scan, and the session that came of the last one.
import {effect, signal} from '@preact/signals';
import {answer, api, type Schemas} from '../../api/client';
import {onEvent} from '../../api/events';
import {rig} from '../../state/rig';
import {newRequestId} from '../jobs/jobs';
import {withDevicesFree} from './devices';
import {holdOf} from './hold';
import {scanRequest} from './proposal';

export type Session = Schemas['Session'];

/** What this desk scanned last: shown until the next cloth. */
export const scanned = signal<Session | null>(null);
export const showsScanned = signal(false);

/** One press is one scan, however long the daemon takes to say that it began. */
export async function beginScan(reason: string): Promise<void> {
  const request = {...scanRequest.value, request_id: newRequestId()};
  const body = reason === '' ? request : {...request, accept_moved: reason};
  await withDevicesFree(() => answer(api.POST('/api/v1/scan', {body})));
}

/** Takes what is missing of a session that did not end. */
export async function goOnWith(session: string): Promise<void> {
  await withDevicesFree(() => answer(api.POST('/api/v1/scan', {body: {session}})));
}

export async function ask(what: 'pause' | 'resume' | 'cancel'): Promise<void> {
  await answer(api.POST(`/api/v1/scan/${what}`, {body: {}}));
}

/** Pauses, or goes on: after a fault with the same session, all of its photographs kept. */
export async function pauseOrGoOn(): Promise<void> {
  const hold = rig.value && holdOf(rig.value);
  if (hold) await withDevicesFree(() => ask(hold));
}

export async function shootAgain(session: string, index: number, exposure_us: number): Promise<void> {
  const path = {name: session, index};
  await withDevicesFree(() => answer(api.POST('/api/v1/sessions/{name}/frames/{index}/again', {params: {path}, body: {exposure_us}})));
}

let last = '';

/** What comes late of a scan before the last one is not shown any more. */
async function fetchScanned(name: string): Promise<void> {
  const session = await answer(api.GET('/api/v1/sessions/{name}', {params: {path: {name}}}));
  if (name === last) scanned.value = session;
}

async function show(session: string): Promise<void> {
  last = session;
  await fetchScanned(session).catch(() => {});
  if (session === last) showsScanned.value = scanned.value?.name === session;
}

/** Histograms are counted after the scan: asked for until all are there. */
const histogramsEvery_ms = 700;

/** Has the session of the last scan at hand, from its end on; returns what ends that. */
export function followScanned(): () => void {
  let wasAtWork = false;
  const stopEnds = effect(() => {
    const status = rig.value;
    if (!status) return;
    const isAtWork = status.state === 'scanning' || status.state === 'connecting' || status.state === 'paused';
    if (wasAtWork && !isAtWork && status.session && status.phase === 'complete') void show(status.session);
    wasAtWork = isAtWork;
  });
  const stopCounting = effect(() => {
    const session = scanned.value;
    if (!session || session.histograms_complete || session.state !== 'complete') return undefined;
    const timer = setTimeout(() => void fetchScanned(session.name).catch(() => {}), histogramsEvery_ms);
    return () => clearTimeout(timer);
  });
  // What is made of it tells more of what it is worth.
  const stopJobs = onEvent('job', (job) => {
    if (job.ended !== '' && job.of === scanned.value?.name) void fetchScanned(job.of).catch(() => {});
  });
  return () => {
    stopEnds();
    stopCounting();
    stopJobs();
  };
}

/** The current solve of a session; null: none yet. */
export async function currentSolve(session: string): Promise<string | null> {
  const {current_solve} = await answer(api.GET('/api/v1/sessions/{name}', {params: {path: {name: session}}}));
  return current_solve || null;
}

/** Calls `changed` with the current solve of a session, now and when one is done; returns what ends that. */
export function followSolve(session: string, changed: (solve: string | null) => void): () => void {
  const askNow = () => currentSolve(session).then(changed, () => changed(null));
  void askNow();
  return onEvent('job', (job) => {
    if (job.of === session && job.kind === 'solve' && job.state === 'done') void askNow();
  });
}

/** A low lamp from the upper left, which shows the weave. */
const lamp = '-0.6,0.5,0.62';

/** The whole cloth in one picture of at most 512 pixels, under one lamp. */
export function relitPicture(session: string, solve: string): string {
  return `/api/v1/sessions/${session}/solves/${solve}/tiles/relit/top/0_0.jpg?light=${lamp}`;
}
