// SPDX-License-Identifier: Apache-2.0
// One click to what no rig should photograph, and what the solver says of each of its pixels.
import {useEffect, useState} from 'preact/hooks';
import {go} from '../../state/address';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {textIn} from '../../ui/fields';
import {addressOfViewer, FIRST_SIGHT} from '../viewer/sight';
import {jobs, queueJob, useJobs} from './jobs';
import {errorOf} from './price';
import {hasEnded} from './queue';

export function TortureScene() {
  useJobs();
  const [id, setId] = useState('');
  const make = useAction(async () => setId((await queueJob({kind: 'torture'})).id));
  const job = jobs.value.find((each) => each.id === id);
  const solve = textIn(job?.result, 'id');
  useEffect(() => {
    if (solve) go(addressOfViewer({session: textIn(job?.result, 'session'), solve}, {...FIRST_SIGHT, layer: 'status'}));
  }, [solve]);
  return (
    <>
      <p class="dim">Lights that close up, twelve decades of exposure, readings lost: what the solver says of pixels that are hard to solve.</p>
      <Button isDisabled={make.isBusy || (job !== undefined && !hasEnded(job))} onClick={() => void make.run()}>Torture scene</Button>
      {job && !hasEnded(job) && <span role="status">{job.phase || 'waits its turn'}</span>}
      <Complaint error={make.complaint ?? (job?.state === 'failed' ? errorOf(job) : null)} />
    </>
  );
}
