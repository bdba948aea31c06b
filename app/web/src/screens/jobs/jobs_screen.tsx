// SPDX-License-Identifier: Apache-2.0
import './jobs.css';
import {useState} from 'preact/hooks';
import {amend, place} from '../../state/address';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {Empty} from '../../ui/empty';
import {JobRow} from './job_row';
import {askOlder, complaint, jobs, olderThan, queue, useJobs} from './jobs';
import {Log} from './log';
import {Price} from './price';
import type {Job} from './queue';
import {HardCases} from './torture';

/** What the daemon works at, what waits and what was done; what each level would cost for a session, and hard cases. */
export default function JobsScreen() {
  useJobs();
  const [logged, showLog] = useState<Job | null>(null);
  const session = place.value.query.get('price');
  const isOfHardCases = place.value.query.has('hard');
  const {running, waiting, ended} = queue.value;
  return (
    <div class="page jobs">
      <div class="row"><h1>Jobs</h1> <a href="/batches">Batches</a></div>
      <Complaint error={complaint.value} />
      {session && <Price session={session} />}
      {isOfHardCases && <HardCases />}
      {(session || isOfHardCases) && <div><Button kind="quiet" onClick={() => amend({price: null, hard: null})}>Only the jobs</Button></div>}
      {jobs.value.length === 0 && (
        <Empty says="Nothing was asked for yet.">
          <a href="/sessions">Choose one from the library</a>
        </Empty>
      )}
      <JobList title="Running" jobs={running} onLog={showLog} />
      <JobList title="Waiting" jobs={waiting} canGoFirst={waiting.length > 1} onLog={showLog} />
      <JobList title="Done" jobs={ended} onLog={showLog} />
      {olderThan.value && <div><Button onClick={() => void askOlder()}>Older ones</Button></div>}
      {logged && <Log job={logged} onClose={() => showLog(null)} />}
    </div>
  );
}

interface JobListProps {
  title: string;
  jobs: readonly Job[];
  canGoFirst?: boolean;
  onLog: (job: Job) => void;
}

function JobList({title, jobs: list, canGoFirst, onLog}: JobListProps) {
  if (list.length === 0) return null;
  return (
    <section>
      <h2>{title} <span class="dim">{list.length}</span></h2>
      <ul class="job-list">
        {list.map((job) => <JobRow key={job.id} job={job} canGoFirst={canGoFirst} onLog={onLog} />)}
      </ul>
    </section>
  );
}
