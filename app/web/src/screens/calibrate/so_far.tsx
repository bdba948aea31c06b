// SPDX-License-Identifier: Apache-2.0
// What the photographs by now would give, which tells whether one more is worth its while.
import {useEffect, useState} from 'preact/hooks';
import {asApiError, type ApiError} from '../../api/client';
import {Complaint} from '../../ui/complaint';
import {textIn} from '../../ui/fields';
import {errorOf} from '../jobs/price';
import {stateOf} from '../jobs/queue';
import {jobs, queueJob} from '../jobs/state';
import type {JobRequest} from './walk';

/** Of one trial for as long as it is shown. */
export function SoFar({trial}: {trial: JobRequest}) {
  const [id, know] = useState<string | null>(null);
  const [complaint, complain] = useState<ApiError | null>(null);
  useEffect(() => {
    queueJob(trial).then((job) => know(job.id), (error: unknown) => complain(asApiError(error)));
  }, []);
  const job = jobs.value.find((each) => each.id === id);
  return (
    <section class="so-far" aria-labelledby="so-far-title">
      <h3 id="so-far-title">So far</h3>
      {job && <p role="status">{job.state === 'done' ? textIn(job.result, 'summary') : stateOf(job)}</p>}
      {job?.state === 'failed' && <Complaint error={errorOf(job)} />}
      <Complaint error={complaint} />
    </section>
  );
}
