// SPDX-License-Identifier: Apache-2.0
import {useState} from 'preact/hooks';
import {asApiError, type ApiError} from '../../api/client';
import {titleOf} from '../../state/forms';
import {ClothName} from '../../ui/cloth_name';
import {textIn} from '../../ui/fields';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {Mark, type Verdict} from '../../ui/mark';
import {Share} from '../../ui/share';
import {durationOf, timeOf} from '../../ui/words';
import {cancel, forget, putFirst, retry} from './jobs';
import {errorOf} from './price';
import {hasEnded, stateOf, wishOf, type Job} from './queue';

interface JobRowProps {
  job: Job;
  /** Whether putting it first changes anything. */
  canGoFirst?: boolean;
  onLog: (job: Job) => void;
}

/** What a job is, how it is, and what can be done with it. */
export function JobRow({job, canGoFirst = false, onLog}: JobRowProps) {
  const [complaint, complain] = useState<ApiError | null>(null);
  const on = (act: (id: string) => Promise<void>) => () => {
    complain(null);
    act(job.id).catch((error: unknown) => complain(asApiError(error)));
  };
  return (
    <li class="job">
      <div class="what">
        <strong>{titleOf(job.kind)}</strong> {wishOf(job)} <Subject job={job} />
      </div>
      <div class="state"><Mark verdict={verdictOf(job)}>{stateOf(job)}</Mark></div>
      <div class="how-far">
        {job.state === 'running' ? <Share label={`Job ${job.id}`} share={job.share} left_s={job.left_s} /> : <Times job={job} />}
      </div>
      <div class="actions row">
        {canGoFirst && <Button onClick={on(putFirst)} label={`Put ${job.id} first`}>First</Button>}
        {hasEnded(job)
          ? canBeDoneAgain(job) && <Button onClick={on(retry)} label={`Do ${job.id} again`}>Again</Button>
          : <Button onClick={on(cancel)} label={`Cancel ${job.id}`}>Cancel</Button>}
        <Button kind="quiet" onClick={() => onLog(job)} label={`Log of ${job.id}`}>Log</Button>
        {hasEnded(job) && <Button kind="quiet" onClick={on(forget)} label={`Forget ${job.id}`}>Forget</Button>}
      </div>
      <Complaint error={complaint ?? (job.state === 'failed' ? errorOf(job) : null)} />
    </li>
  );
}

/** The session or folder, and where its result can be looked at. */
function Subject({job}: {job: Job}) {
  const solve = ['solve', 'torture'].includes(job.kind) && job.state === 'done' ? textIn(job.result, 'id') : '';
  const isOfMaps = ['maps', 'finish'].includes(job.kind) && job.state === 'done';
  if (job.kind === 'rig_plan') return <a href="/calibrate">{job.of}</a>;
  if (job.kind.startsWith('batch_')) return <a href={`/batches/${job.of}`}>{job.of}</a>;
  if (job.of.includes('/')) return <span>{job.of}</span>;
  return (
    <>
      <a href={`/sessions/${job.of}`}><ClothName session={job.of} /></a>
      {isOfMaps && <> <a href={`/viewer/${job.of}/maps/${textIn(job.result, 'id')}`}>Look at them</a></>}
      {solve && <> <a href={`/viewer/${job.of}/${solve}`}>Look at it</a></>}
      {job.kind === 'torture' && <> <a href="/jobs?hard">Hard cases</a></>}
      {job.kind === 'price' && job.state === 'done' && <> <a href={`/jobs?price=${job.of}`}>Levels</a></>}
    </>
  );
}

/** A plan that is made never changes. */
function canBeDoneAgain({kind, state}: Job): boolean {
  return kind !== 'batch_plan' || state !== 'done';
}

function Times({job}: {job: Job}) {
  if (!hasEnded(job)) return <span class="dim">asked {timeOf(job.asked)}</span>;
  return (
    <span class="dim">
      {job.began && `took ${durationOf(job.seconds)}, `}ended {timeOf(job.ended)}{job.by && `, for ${job.by}`}
    </span>
  );
}

function verdictOf(job: Job): Verdict {
  if (job.state === 'failed') return 'fault';
  if (job.state === 'running') return job.held ? 'waiting' : 'busy';
  if (job.state === 'done') return job.exit_code ? 'warning' : 'fine';
  return 'waiting';
}
