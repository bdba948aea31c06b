// SPDX-License-Identifier: Apache-2.0
// Which light to add, before a screw is turned: what each would tell of a cloth, and what it costs a scan.
import {useState} from 'preact/hooks';
import {formOf} from '../../state/forms';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {Mark} from '../../ui/mark';
import type {Wish} from '../../ui/request_schema';
import {age} from '../../ui/say';
import {SchemaForm} from '../../ui/schema_form';
import {Share} from '../../ui/share';
import {Table} from '../../ui/table';
import {durationOf} from '../../ui/words';
import {cancel, jobs, queueJob} from '../jobs/jobs';
import {errorOf} from '../jobs/price';
import {hasEnded, type Job} from '../jobs/queue';
import {lightPlanOf, signed, type LightPlan, type LightRow} from './light_plan';

export function LightPlanPanel() {
  const [wish, setWish] = useState<Wish>({});
  const plan = useAction(() => queueJob({kind: 'rig_plan', ...wish}));
  const planned = jobs.value.find((job) => job.kind === 'rig_plan' && job.state !== 'cancelled');
  const isBusy = planned !== undefined && !hasEnded(planned);
  return (
    <section class="panel light-plan" aria-labelledby="light-plan-title">
      <h2 id="light-plan-title">Which light to add</h2>
      <SchemaForm schema={formOf('rig_plan')} wish={wish} onWish={setWish} />
      <div><Button isDisabled={plan.isBusy || isBusy} onClick={() => void plan.run()}>Say what each light tells</Button></div>
      <Complaint error={plan.complaint} />
      {planned && <Planned job={planned} />}
    </section>
  );
}

function Planned({job}: {job: Job}) {
  if (!hasEnded(job)) {
    return (
      <div class="row">
        <Mark verdict={job.held ? 'waiting' : 'busy'}>{job.phase || 'waits its turn'}</Mark>
        <Share label="Plan" share={job.share} left_s={job.left_s} />
        <Button onClick={() => void cancel(job.id)}>Cancel</Button>
      </div>
    );
  }
  const plan = lightPlanOf(job.result);
  return plan ? <Lights job={job} plan={plan} /> : <Complaint error={errorOf(job)} />;
}

function Lights({job, plan}: {job: Job; plan: LightPlan}) {
  return (
    <>
      <p>{plan.verdict} <span class="dim">{plan.cloth} under the {plan.leds} LEDs of {plan.rig}, {age(job.ended)}</span></p>
      <div class="lights">
        <div>
          <Table caption="What each light tells" rows={plan.rows.map((row) => ({key: row.name, cells: cellsOf(row, plan)}))}
            heads={['Lights', 'Normal', ...(plan.strength ? ['Alpha', plan.strength === 'sheen' ? 'Sheen' : 'F0', 'Observable'] : []), 'Shots', 'Time', 'Won']} />
          <p class="dim">Standard deviations; shots and time are those that each scan takes more.</p>
          {plan.notes.map((note) => <p key={note} class="dim">{note}</p>)}
        </div>
        <img src={`/api/v1/jobs/${job.id}/files/plan.svg`} alt="Places for one more LED, seen from the camera, in the colour of what each wins" />
      </div>
    </>
  );
}

function cellsOf(row: LightRow, {strength}: LightPlan) {
  const lobe = [row.alpha?.toFixed(4) ?? '-', row.strength?.toFixed(4) ?? '-', <Mark verdict={row.isObservable ? 'fine' : 'waiting'}>{row.isObservable ? 'yes' : 'no'}</Mark>];
  return [
    row.what,
    row.normal_deg === null ? '-' : `${row.normal_deg.toFixed(3)}°`,
    ...(strength ? lobe : []),
    signed(row.shots),
    row.seconds === 0 ? '0' : `+${durationOf(row.seconds)}`,
    row.won_deg === null ? '-' : `${signed(row.won_deg, 3)}°`,
  ];
}
