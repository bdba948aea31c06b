// SPDX-License-Identifier: Apache-2.0
// A walk from photographs to an accepted calibration, stage by stage.
import {useEffect, useState} from 'preact/hooks';
import {asApiError, type ApiError} from '../../api/client';
import {amend, place} from '../../state/address';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {textIn} from '../../ui/fields';
import {Mark, type Verdict} from '../../ui/mark';
import {Offers} from '../../ui/offers';
import {jobs, queueJob} from '../jobs/jobs';
import {errorOf} from '../jobs/price';
import {stateOf} from '../jobs/queue';
import {Acceptance} from './acceptance';
import {Begin} from './begin';
import {Calculation} from './calculation';
import {complaint, isKnown, known, work} from './calibrations';
import {SetPanel} from './set_panel';
import {
  currentStage, hasResult, isUnharmed, madeBy, posesIn, setOf, stagesOf, standingOf, trialsOf, type JobRequest, type Standing, type Walk, type WalkStage,
} from './walk';

const marks: Record<Standing, {verdict: Verdict; says: string}> = {
  open: {verdict: 'waiting', says: 'to do'},
  working: {verdict: 'busy', says: 'calculating'},
  failed: {verdict: 'fault', says: 'failed'},
  done: {verdict: 'fine', says: 'done'},
  found: {verdict: 'warning', says: 'done, with findings'},
};

export function WalkPage({walk}: {walk: Walk}) {
  const stages = stagesOf(walk, known.value);
  const chosen = stages.find((stage) => stage.result === place.value.query.get('step'));
  const current = currentStage(walk, known.value);
  const stage = chosen ?? current ?? stages.at(-1);
  const made = madeBy(walk, known.value);
  const isAtEnd = current === null || isUnharmed(walk, known.value);
  if (!isKnown.value || !stage) return null;
  return (
    <div class="walk">
      <aside aria-label="Stages">
        <a href="/calibrate">Calibration of the rig</a>
        <h1>{walk.kind === 'all' ? 'Whole calibration' : 'After a knock'} <span class="dim">{walk.name}</span></h1>
        <ol class="stages">
          {stages.map((each) => <StageItem key={each.result} walk={walk} stage={each} isShown={each === stage} />)}
        </ol>
      </aside>
      <section class="stage" aria-labelledby="stage-title">
        <h2 id="stage-title">{stage.title}</h2>
        <Complaint error={complaint.value} />
        <StagePanel key={`${walk.name}-${stage.result}`} walk={walk} stage={stage} />
        {isUnharmed(walk, known.value) && <p role="status">Nothing moved that maps would show. The rig may scan on.</p>}
        {isAtEnd && made !== null && <Acceptance folder={made} />}
      </section>
    </div>
  );
}

function StageItem({walk, stage, isShown}: {walk: Walk; stage: WalkStage; isShown: boolean}) {
  const {verdict, says} = marks[standingOf(walk, stage, known.value)];
  return (
    <li aria-current={isShown ? 'step' : undefined}>
      <button type="button" onClick={() => amend({step: stage.result})}>
        <strong>{stage.title}</strong>
        <Mark verdict={verdict}>{stage.is_optional && verdict === 'waiting' ? 'to do, or leave it' : says}</Mark>
        <span class="dim">{stage.about}</span>
      </button>
    </li>
  );
}

/** Photographs first, then what is calculated of them. */
function StagePanel({walk, stage}: {walk: Walk; stage: WalkStage}) {
  const set = work.value?.name === setOf(walk, stage) ? work.value : null;
  const standing = standingOf(walk, stage, known.value);
  const isOver = hasResult(standing);
  const isToPhotograph = !isOver && !stage.is_photographed;
  const isBegun = set?.photographs.some((photograph) => photograph.used) ?? false;
  const trials = set ? trialsOf(walk, stage, set, known.value) : [];
  const soFar = trials.length > 0 && (
    <section class="so-far" aria-labelledby="so-far-title">
      <h3 id="so-far-title">So far</h3>
      {trials.map((trial) => <Trial key={trial.request_id} trial={trial} />)}
    </section>
  );
  const calculation = !stage.is_aside && <Calculation walk={walk} stage={stage} isEnough={stage.is_photographed || (set?.done ?? false)} />;
  return (
    <>
      {isToPhotograph && set === null && <Begin walk={walk} stage={stage} />}
      {isToPhotograph && set !== null && <SetPanel set={set} soFar={soFar}>{isBegun && calculation}</SetPanel>}
      {!isToPhotograph && calculation}
      {isOver && stage.is_aside && <p role="status">Its photographs are there. The sensor is measured by them, too.</p>}
      {isOver && <Next walk={walk} />}
    </>
  );
}

/** What the photographs by now would give; once a person asks for it, what more of them would. */
function Trial({trial}: {trial: JobRequest}) {
  const [id, know] = useState<string | null>(null);
  const [refused, refuse] = useState<ApiError | null>(null);
  const [isWanted, want] = useState(!trial.kind.endsWith('_price'));
  useEffect(() => {
    if (isWanted) queueJob(trial).then((job) => know(job.id), (error: unknown) => refuse(asApiError(error)));
  }, [isWanted]);
  const job = jobs.value.find((each) => each.id === id);
  const says = job && (job.state === 'done' ? textIn(job.result, 'summary') : stateOf(job));
  return (
    <>
      {!isWanted && <Button kind="quiet" onClick={() => want(true)}>What more poses buy</Button>}
      {says && <p role="status">{says}</p>}
      <Offers label="More poses" offers={posesIn(job?.result)} />
      {job?.state === 'failed' && <Complaint error={errorOf(job)} />}
      <Complaint error={refused} />
    </>
  );
}

function Next({walk}: {walk: Walk}) {
  const next = currentStage(walk, known.value);
  if (!next || isUnharmed(walk, known.value)) return null;
  return <div><Button kind="main" onClick={() => amend({step: null})}>Go on: {next.title.toLowerCase()}</Button></div>;
}
