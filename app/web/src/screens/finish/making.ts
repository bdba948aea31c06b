// SPDX-License-Identifier: Apache-2.0
// Maps on their way: a preview a little after each change of the recipe, and all of them when they are asked for.
import {useEffect, useState} from 'preact/hooks';
import {type ApiError, asApiError, type Schemas} from '../../api/client';
import {cancel, jobs, putFirst, queueJob} from '../jobs/jobs';
import {hasEnded, type Job} from '../jobs/queue';
import type {Recipe} from './recipe';

const pause_ms = 400;

export interface Of {
  session: string;
  /** Empty: the session's current one. */
  solve: string;
  /** It is a preview, and a person wants maps of it all the same. */
  isDraft?: boolean;
}

export function requestOf({session, solve, isDraft}: Of, recipe: Recipe, isPreview: boolean): Schemas['MapsJob'] | Schemas['FinishJob'] {
  return {
    kind: isPreview ? 'finish' : 'maps',
    session,
    ...(solve && {solve}),
    ...(isDraft && {draft: true}),
    ...(isPreview && {preview: true}),
    steps: {steps: [...recipe]},
  };
}

/** The job's own document as it is by now. */
export function jobWith(id: string): Job | null {
  return jobs.value.find((job) => job.id === id) ?? null;
}

export interface Preview {
  /** The one that is being made. */
  job: Job | null;
  /** What the last one left: its maps.json. */
  document: unknown;
  complaint: ApiError | null;
}

/** A preview of the recipe, made anew when that changes; the one before is given up. */
export function usePreview(of: Of, recipe: Recipe): Preview {
  const [id, setId] = useState('');
  const [made, setMade] = useState<unknown>(null);
  const [complaint, setComplaint] = useState<ApiError | null>(null);
  const words = JSON.stringify(recipe);
  useEffect(() => {
    if (recipe.length === 0) return undefined;
    let queued = '';
    let isOld = false;
    setComplaint(null);
    setId('');
    const begin = async () => {
      const job = await queueJob(requestOf(of, recipe, true));
      queued = job.id;
      if (isOld) return giveUp(queued);
      setId(queued);
      if (hasOthersBefore(job)) await putFirst(queued).catch(() => {});  // it may run by now
    };
    const timer = window.setTimeout(() => begin().catch((error: unknown) => setComplaint(asApiError(error))), pause_ms);
    return () => {
      isOld = true;
      clearTimeout(timer);
      void giveUp(queued);
    };
  }, [of.session, of.solve, of.isDraft, words]);
  const job = jobWith(id);
  useEffect(() => {
    if (job?.state === 'done' && job.result) setMade(job.result);
  }, [job?.state, job?.result]);
  return {job, document: recipe.length > 0 ? made : null, complaint};
}

/** Behind the job that runs it is the next anyway. */
function hasOthersBefore({state, place}: Job): boolean {
  return state === 'queued' && (place ?? 1) > 1;
}

async function giveUp(id: string): Promise<void> {
  const job = jobWith(id);
  if (job && !hasEnded(job)) await cancel(id).catch(() => {});  // it may have ended by now
}
