// SPDX-License-Identifier: Apache-2.0
// What is calculated of a set of photographs: a job, and what it found.
import {asApiError, type ApiError} from '../../api/client';
import {useState} from 'preact/hooks';
import {amend} from '../../state/address';
import {formOf} from '../../state/forms';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {listIn, textIn} from '../../ui/fields';
import {Mark} from '../../ui/mark';
import type {Wish} from '../../ui/request_schema';
import {More} from '../../ui/schema_form';
import {Share} from '../../ui/share';
import {cancel, queueJob} from '../jobs/jobs';
import {errorOf} from '../jobs/price';
import type {Job} from '../jobs/queue';
import {known} from './calibrations';
import {findingsIn, hasResult, notesBeside, jobOf, requestOf, standingOf, type JobRequest, type Walk, type WalkStage} from './walk';

interface CalculationProps {
  walk: Walk;
  stage: WalkStage;
  /** Whether the photographs suffice; else a person may say so. */
  isEnough: boolean;
}

/** What the walk itself says. */
const saidHere = ['input', 'session', 'moved', 'from', 'output', 'trap'];

export function Calculation({walk, stage, isEnough}: CalculationProps) {
  const [complaint, complain] = useState<ApiError | null>(null);
  const [wish, setWish] = useState<Wish>({});
  const job = jobOf(walk, stage, known.value);
  const standing = standingOf(walk, stage, known.value);
  /** The stage stays chosen, so that its result is read before the next one begins. */
  const calculate = () => {
    complain(null);
    amend({step: stage.result});
    queueJob({...requestOf(walk, stage, known.value), ...wish} as JobRequest).catch((error: unknown) => complain(asApiError(error)));
  };
  if (job && standing === 'working') return <Working job={job} />;
  return (
    <section class="calculation">
      {job && hasResult(standing) && <Result job={job} />}
      {standing === 'failed' && job && <Complaint error={errorOf(job)} />}
      <Complaint error={complaint} />
      {!hasResult(standing) && <More of={stage.title.toLowerCase()} schema={formOf(stage.job)} wish={wish} onWish={setWish} without={saidHere} />}
      {!hasResult(standing) && (
        <Button kind={isEnough ? 'main' : 'plain'} onClick={calculate}>
          {isEnough ? `Calculate: ${stage.title.toLowerCase()}` : 'Enough: calculate with these'}
        </Button>
      )}
    </section>
  );
}

function Working({job}: {job: Job}) {
  return (
    <section class="calculation">
      <div class="row">
        <Mark verdict={job.held ? 'waiting' : 'busy'}>{job.phase || 'waits its turn'}</Mark>
        <Share label="Calculation" share={job.share} left_s={job.left_s} />
        <Button onClick={() => void cancel(job.id)}>Cancel</Button>
      </div>
    </section>
  );
}

/** The report's summary, and what is wrong or weak in it with what to do. */
export function Result({job}: {job: Job}) {
  const findings = findingsIn(listIn(job.result, 'verdicts'));
  return (
    <div class="result">
      <p>{textIn(job.result, 'summary')}</p>
      {findings.length > 0 && (
        <ul>
          {findings.map(({text, remedy}) => (
            <li key={text}><Mark verdict="warning">{text}</Mark>{remedy && <p class="dim">{remedy}</p>}</li>
          ))}
        </ul>
      )}
      {notesBeside(job.notes, findings).map((note) => <p key={note} class="dim">{note}</p>)}
    </div>
  );
}
