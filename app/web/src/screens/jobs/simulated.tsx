// SPDX-License-Identifier: Apache-2.0
// One click to a cloth that no rig photographs: it is simulated and solved.
import {useEffect, useState} from 'preact/hooks';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {textIn} from '../../ui/fields';
import {JobLine} from '../material/job_line';
import type {SolveName} from '../viewer/sight';
import {jobs, queueJob, useJobs} from './jobs';
import {hasEnded} from './queue';

interface SimulatedProps {
  says: string;
  isMain?: boolean;
  onMade: (name: SolveName) => void;
}

/** A job that runs already is followed too. */
export function Simulated({says, isMain, onMade}: SimulatedProps) {
  useJobs();
  const [id, setId] = useState('');
  const make = useAction(async () => setId((await queueJob({kind: 'sample'})).id));
  const job = jobs.value.find((each) => each.id === id || (each.kind === 'sample' && !hasEnded(each)));
  const solve = textIn(job?.result, 'id');
  useEffect(() => {
    if (job) setId(job.id);
  }, [job?.id]);
  useEffect(() => {
    if (solve) onMade({session: textIn(job?.result, 'session'), solve});
  }, [solve]);
  return (
    <>
      <Button kind={isMain ? 'main' : 'plain'} isDisabled={make.isBusy || (job !== undefined && !hasEnded(job))} onClick={() => void make.run()}>{says}</Button>
      <Complaint error={make.complaint} />
      {job && <JobLine job={job} />}
    </>
  );
}
