// SPDX-License-Identifier: Apache-2.0
// The jobs as the daemon last told of them, for every screen that shows some.
import {computed, signal} from '@preact/signals';
import {useEffect} from 'preact/hooks';
import {answer, api, asApiError, type ApiError, type Schemas} from '../../api/client';
import {onEvent} from '../../api/events';
import {hasEnded, merged, queueOf, withEvent, type Job} from './queue';

const pageLength = 50;

export const jobs = signal<readonly Job[]>([]);
export const queue = computed(() => queueOf(jobs.value));
/** Where the next page of history begins; null: all are here. */
export const olderThan = signal<string | null>(null);
export const complaint = signal<ApiError | null>(null);

async function ask(after?: string): Promise<void> {
  try {
    const page = await answer(api.GET('/api/v1/jobs', {params: {query: {limit: pageLength, after}}}));
    jobs.value = merged(jobs.value, page.jobs);
    if (after !== undefined || olderThan.value === null) olderThan.value = page.after;
    complaint.value = null;
  } catch (error) {
    complaint.value = asApiError(error);
  }
}

export async function askOlder(): Promise<void> {
  if (olderThan.value !== null) await ask(olderThan.value);
}

/** An event has no result: what has ended is asked for. */
async function hear(event: Schemas['JobEvent']): Promise<void> {
  jobs.value = withEvent(jobs.value, event);
  if (!hasEnded(event)) return;
  const job = await answer(api.GET('/api/v1/jobs/{id}', {params: {path: {id: event.id}}})).catch(() => null);
  if (job) jobs.value = merged(jobs.value, [job]);
}

/** Keeps the jobs up to date for as long as a component is shown. */
export function useJobs(): void {
  useEffect(() => {
    void ask();
    const ends = [onEvent('job', (event) => void hear(event)), onEvent('gap', () => void ask())];
    return () => ends.forEach((end) => end());
  }, []);
}

/** Works on plain http too, where a browser has no randomUUID. */
export function newRequestId(): string {
  const bytes = crypto.getRandomValues(new Uint8Array(12));
  return `page-${[...bytes].map((byte) => byte.toString(16).padStart(2, '0')).join('')}`;
}

interface Asked {
  id: string;
  /** The job that it became; null: the daemon has not answered yet. */
  job: string | null;
}

/** The same request again is the same job until that has ended: however often a button is pressed, its work is done once. */
export class Requests {
  private readonly asked = new Map<string, Asked>();

  idOf(request: object, isOver: (job: string) => boolean): string {
    const key = JSON.stringify(request);
    const before = this.asked.get(key);
    if (before && (before.job === null || !isOver(before.job))) return before.id;
    const id = newRequestId();
    this.asked.set(key, {id, job: null});
    return id;
  }

  answered(request: object, job: string): void {
    const asked = this.asked.get(JSON.stringify(request));
    if (asked) asked.job = job;
  }

  refused(request: object): void {
    this.asked.delete(JSON.stringify(request));
  }
}

const requests = new Requests();

function isOver(id: string): boolean {
  return jobs.value.some((job) => job.id === id && hasEnded(job));
}

/** Asks for a job and shows it at once. The same again is the same job until that has ended; one with an id, for good. */
export async function queueJob(request: Schemas['JobRequest']): Promise<Job> {
  const request_id = request.request_id ?? requests.idOf(request, isOver);
  try {
    const job = await answer(api.POST('/api/v1/jobs', {body: {...request, request_id}}));
    requests.answered(request, job.id);
    jobs.value = merged(jobs.value, [job]);
    return job;
  } catch (error) {
    requests.refused(request);
    throw error;
  }
}

export async function cancel(id: string): Promise<void> {
  const job = await answer(api.POST('/api/v1/jobs/{id}/cancel', {params: {path: {id}}, body: {}}));
  jobs.value = merged(jobs.value, [job]);
}

export async function retry(id: string): Promise<void> {
  const job = await answer(api.POST('/api/v1/jobs/{id}/retry', {params: {path: {id}}, body: {}}));
  jobs.value = merged(jobs.value, [job]);
}

/** Its place in the queue is known by asking for all again: a list is in the order of ids. */
export async function putFirst(id: string): Promise<void> {
  const job = await answer(api.POST('/api/v1/jobs/{id}/first', {params: {path: {id}}, body: {}}));
  jobs.value = merged(jobs.value, [job]);
}

export async function forget(id: string): Promise<void> {
  await answer(api.DELETE('/api/v1/jobs/{id}', {params: {path: {id}}}));
  jobs.value = jobs.value.filter((job) => job.id !== id);
}

export async function logOf(id: string): Promise<string> {
  return await answer(api.GET('/api/v1/jobs/{id}/log', {params: {path: {id}}, parseAs: 'text'}));
}
