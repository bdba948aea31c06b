// SPDX-License-Identifier: Apache-2.0
import {useState} from 'preact/hooks';
import {answer, api, asApiError, type ApiError, type Schemas} from '../../api/client';
import {go} from '../../state/address';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {Dialog} from '../../ui/dialog';
import {Empty} from '../../ui/empty';
import {counted} from '../../ui/say';
import {useLatest} from '../../ui/use_latest';
import {durationOf} from '../../ui/words';
import {JobRow} from '../jobs/job_row';
import {jobs, queueJob} from '../jobs/jobs';
import {Log} from '../jobs/log';
import {hasEnded, type Job} from '../jobs/queue';
import type {BatchReport} from './changes';
import {PlanView} from './plan_view';
import {ReportView} from './report_view';

/** One batch: its plan, how far it is, and what changed. */
export function BatchPage({name}: {name: string}) {
  const [one, setOne] = useState<Schemas['OneBatch'] | null>(null);
  const [report, setReport] = useState<BatchReport | null>(null);
  const [complaint, complain] = useState<ApiError | null>(null);
  const [isAsked, ask] = useState(false);
  const [accepted, setAccepted] = useState(false);
  const [logged, showLog] = useState<Job | null>(null);
  const [job] = jobs.value.filter(({kind, of}) => kind.startsWith('batch_') && of === name);
  const params = {path: {name}};
  useLatest((latest) => {
    const look = async () => {
      const said = await answer(api.GET('/api/v1/batches/{name}', {params}));
      return {said, report: said.done?.solved || said.done?.failed ? await answer(api.GET('/api/v1/batches/{name}/report', {params})) : null};
    };
    latest(look()).then((seen) => {
      setOne(seen.said);
      setReport(seen.report);
      complain(null);
    }, (error: unknown) => complain(asApiError(error)));
  }, [name, job?.id, job?.state]);
  const run = (retry_failed: boolean) => queueJob({kind: 'batch_run', batch: name, ...(retry_failed && {retry_failed})});
  const begin = useAction(() => run(false));
  const again = useAction(() => run(true));
  const forget = useAction(async () => {
    await answer(api.DELETE('/api/v1/batches/{name}', {params}));
    go('/batches');
  });
  const isBusy = job !== undefined && !hasEnded(job);
  const {batch, plan, done} = one ?? {};
  return (
    <div class="page jobs batches">
      <h1>Batch {name}</h1>
      <Complaint error={complaint} />
      {job && <ul class="job-list"><JobRow job={job} onLog={showLog} /></ul>}
      {batch && !plan && !job && <Empty says="It has no plan."><a href="/sessions">Choose sessions in the library</a></Empty>}
      {batch && plan && done && (
        <section class="panel" aria-labelledby="plan-title">
          <h2 id="plan-title">{counted(batch.sessions, 'session')}, {durationOf(batch.seconds)}</h2>
          <div class="row">
            <Button kind="main" isDisabled={isBusy || done.missing === 0} onClick={() => void begin.run()}>Run</Button>
            {done.failed > 0 && <Button isDisabled={isBusy} onClick={() => void again.run()}>Try failed ones again</Button>}
            <span role="status">{done.solved} solved, {done.failed} failed, {done.missing} to be solved</span>
          </div>
          <Complaint error={begin.complaint ?? again.complaint} />
          <PlanView plan={plan} />
        </section>
      )}
      {accepted && <p role="status">The new solves are the current ones.</p>}
      {report && <ReportView name={name} report={report} onAccepted={() => setAccepted(true)} />}
      {batch && <div><Button kind="quiet" onClick={() => ask(true)}>Forget...</Button></div>}
      {isAsked && (
        <Dialog title={`Forget batch ${name}`} onClose={() => ask(false)}>
          <p>Its plan and its report go. Solves stay.</p>
          <Complaint error={forget.complaint} />
          <div class="row">
            <Button kind="danger" onClick={() => void forget.run()}>Forget it</Button>
            <Button onClick={() => ask(false)}>Keep it</Button>
          </div>
        </Dialog>
      )}
      {logged && <Log job={logged} onClose={() => showLog(null)} />}
    </div>
  );
}
