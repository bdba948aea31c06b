// SPDX-License-Identifier: Apache-2.0
import {useState} from 'preact/hooks';
import {go} from '../../state/address';
import {formOf, levels} from '../../state/forms';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {Choice} from '../../ui/choice';
import {Complaint} from '../../ui/complaint';
import {Field} from '../../ui/field';
import type {Wish} from '../../ui/request_schema';
import {More} from '../../ui/schema_form';
import {queueJob} from '../jobs/jobs';
import {aims, firstWish, requestOf, scopeInWords, type PlanWish, type Scope} from './plan';

/** What the form and the choice of sessions say. */
const saidHere = ['sessions', 'find', 'quality', 'to_deg', 'within_s'];
const aimWords = {level: 'one level for all', hours: 'the best within hours', degrees: 'the cheapest to an error'};

/** What a batch is to spend, or to reach. Nothing is solved before its plan was seen. */
export function PlanForm({scope}: {scope: Scope}) {
  const [wish, setWish] = useState(firstWish);
  const put = <K extends keyof PlanWish>(key: K) => (value: PlanWish[K]) => setWish({...wish, [key]: value});
  const [said, setSaid] = useState<Wish>({});
  const request = requestOf(scope, wish, said);
  const plan = useAction(async () => {
    if (typeof request !== 'string') go(`/batches/${(await queueJob(request)).of}`);
  });
  return (
    <section class="panel" aria-labelledby="form-title">
      <h2 id="form-title">Plan {scopeInWords(scope)}</h2>
      <div class="row ends">
        <Choice label="Solve by" value={wish.aim} options={aims.map((value) => ({value, says: aimWords[value]}))} onChange={put('aim')} />
        {wish.aim === 'level' && <Choice label="Level" value={wish.quality} options={levels().map((value) => ({value, says: value}))} onChange={put('quality')} />}
        {wish.aim === 'hours' && <Field label="Hours" type="number" value={wish.hours} onInput={put('hours')} />}
        {wish.aim === 'degrees' && <Field label="Mean error" unit="°" type="number" value={wish.degrees} onInput={put('degrees')} />}
      </div>
      <More of="the batch" schema={formOf('batch_plan')} wish={said} onWish={setSaid} without={saidHere} />
      {typeof request === 'string' && <p class="dim" role="status">{request}</p>}
      <div><Button kind="main" isDisabled={plan.isBusy || typeof request === 'string'} onClick={() => void plan.run()}>Plan</Button></div>
      <Complaint error={plan.complaint} />
    </section>
  );
}
