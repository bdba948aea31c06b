// SPDX-License-Identifier: Apache-2.0
// From photographs to exports: what there is, how fresh, and one button that makes the rest.
import {useEffect, useState} from 'preact/hooks';
import {answer, api, type ApiError, asApiError, type Schemas} from '../../api/client';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {Choice} from '../../ui/choice';
import {Complaint} from '../../ui/complaint';
import {Mark, type Verdict} from '../../ui/mark';
import {useLatest} from '../../ui/use_latest';
import {VerdictLine} from '../../ui/verdict';
import {timeOf} from '../../ui/words';
import {jobs, queueJob, useJobs} from '../jobs/jobs';
import {hasEnded} from '../jobs/queue';
import {JobLine} from '../material/job_line';

type Link = Schemas['ChainLink'];

const verdicts: Record<Link['freshness'], Verdict> = {fresh: 'fine', draft: 'warning', stale: 'warning', missing: 'waiting'};

/** Exports are made again where there are some; a preset adds one. */
const asBefore = '';

export function ChainPanel({session: of}: {session: Schemas['Session']}) {
  const session = of.name;
  useJobs();
  const [chain, setChain] = useState<Schemas['Chain'] | null>(null);
  const [presets, setPresets] = useState<readonly string[]>([]);
  const [preset, setPreset] = useState(asBefore);
  const [complaint, complain] = useState<ApiError | null>(null);
  useLatest((latest) => {
    latest(answer(api.GET('/api/v1/sessions/{name}/chain', {params: {path: {name: session}}}))).then(
      (found) => (setChain(found), complain(null)),
      (error: unknown) => complain(asApiError(error)),
    );
  }, [of]);
  useEffect(() => {
    answer(api.GET('/api/v1/presets')).then((list) => setPresets(list.presets.map(({name}) => name)), () => {});
  }, []);
  const make = useAction(() => queueJob({kind: 'make', session, ...(preset !== asBefore && {presets: [preset]})}));
  const job = jobs.value.find(({kind, of}) => kind === 'make' && of === session);
  const isRunning = job !== undefined && !hasEnded(job);
  const links = chain?.links ?? [];
  const isFinal = chain?.fresh ?? false;
  return (
    <section class="panel chain" aria-labelledby="chain-title">
      <h2 id="chain-title">From photographs to files</h2>
      {chain && <VerdictLine verdict={chain.verdict} warnings={of.warnings} />}
      <ol>{links.map((link) => <Row key={`${link.name} ${link.folder}`} session={session} link={link} />)}</ol>
      <div class="row">
        <Choice
          label="Export for"
          value={preset}
          options={[{value: asBefore, says: 'as before'}, ...presets.map((name) => ({value: name, says: name}))]}
          onChange={setPreset}
        />
        <Button kind="main" isDisabled={make.isBusy || isRunning || (isFinal && preset === asBefore)} onClick={() => void make.run()}>Make it final</Button>
        {isFinal && <span class="dim">All of it is fresh.</span>}
      </div>
      {job && <JobLine job={job} />}
      <Complaint error={complaint ?? make.complaint} />
    </section>
  );
}

function Row({session, link: {name, id, freshness, says, why = [], written}}: {session: string; link: Link}) {
  return (
    <li>
      <span>{name}</span>
      <Mark verdict={verdicts[freshness]}>{freshness}</Mark>
      <span>{says} <span class="dim">{why.join('; ')}</span></span>
      {written && <span class="dim numbers">{timeOf(written)}</span>}
      {id && name === 'solve' && <a href={`/viewer/${session}/${id}?panel=finish`}>Finish its maps</a>}
      {id && name === 'maps' && <a href={`/material/${session}/maps/${id}`}>As a material</a>}
    </li>
  );
}
