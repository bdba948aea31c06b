// SPDX-License-Identifier: Apache-2.0
// The job that runs now, for the frame of every screen.
import {signal} from '@preact/signals';
import {answer, api, type Schemas} from '../api/client';
import {onEvent} from '../api/events';

export const runningJob = signal<Schemas['JobEvent'] | null>(null);

async function ask(): Promise<void> {
  const {jobs} = await answer(api.GET('/api/v1/jobs', {params: {query: {limit: 20}}}));
  runningJob.value = jobs.find((job) => job.state === 'running') ?? null;
}

export function followRunningJob(): void {
  const askAgain = () => ask().catch(() => {});
  askAgain();
  onEvent('gap', askAgain);
  onEvent('job', (job) => {
    if (job.state === 'running') runningJob.value = job;
    else if (runningJob.value?.id === job.id) runningJob.value = null;
  });
}
