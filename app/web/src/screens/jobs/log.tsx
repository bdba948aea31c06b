// SPDX-License-Identifier: Apache-2.0
import {useEffect, useState} from 'preact/hooks';
import {asApiError, type ApiError} from '../../api/client';
import {Complaint} from '../../ui/complaint';
import {Copy} from '../../ui/copy';
import {Dialog} from '../../ui/dialog';
import {titleOf} from '../../state/forms';
import {logOf} from './jobs';
import type {Job} from './queue';

/** What the verb of a job said. */
export function Log({job, onClose}: {job: Job; onClose: () => void}) {
  const [text, setText] = useState('');
  const [complaint, complain] = useState<ApiError | null>(null);
  useEffect(() => {
    logOf(job.id).then(setText, (error: unknown) => complain(asApiError(error)));
  }, [job.id]);
  return (
    <Dialog title={`${titleOf(job.kind)} ${job.of}`} onClose={onClose}>
      <Complaint error={complaint} />
      <pre class="log" tabIndex={0} aria-label="Log">{text || 'It said nothing.'}</pre>
      <form method="dialog" class="row">
        <button class="button">Close</button>
        <Copy text={text} />
      </form>
    </Dialog>
  );
}
