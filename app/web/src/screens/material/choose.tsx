// SPDX-License-Identifier: Apache-2.0
// Which material: a cloth that was scanned, or one that is written as layers. Maps that are not there yet are made here.
import {useEffect, useState} from 'preact/hooks';
import {answer, api, type ApiError, asApiError, type Schemas} from '../../api/client';
import {onEvent} from '../../api/events';
import {become} from '../../state/address';
import {clothOf} from '../../state/cloths';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {Empty} from '../../ui/empty';
import {useLatest} from '../../ui/use_latest';
import {jobs, queueJob, useJobs} from '../jobs/jobs';
import {hasEnded} from '../jobs/queue';
import {JobLine} from './job_line';
import {placeOfMaterial} from './material_sight';

const MOST = 100;

export function Choose() {
  const [sessions, setSessions] = useState<Schemas['Summary'][] | null>(null);
  const [materials, setMaterials] = useState<Schemas['MaterialSummary'][]>([]);
  const [complaint, setComplaint] = useState<ApiError | null>(null);
  useEffect(() => {
    const complain = (error: unknown) => setComplaint(asApiError(error));
    answer(api.GET('/api/v1/sessions', {params: {query: {limit: MOST}}})).then((page) => setSessions(page.sessions), complain);
    answer(api.GET('/api/v1/materials')).then((list) => setMaterials(list.materials), complain);
  }, []);
  return (
    <section class="page">
      <h1>Material</h1>
      <Complaint error={complaint} />
      <h2>Cloths that were scanned</h2>
      {sessions?.length === 0 && <Empty says="No cloth is scanned yet."><p><a href="/tour">Ways to begin</a></p></Empty>}
      <ul class="choose-material" aria-label="Cloths">
        {sessions?.map(({name, fabric}) => <li key={name}><a href={`/material/${name}`}>{fabric || name}</a> <span class="dim">{name}</span></li>)}
      </ul>
      <h2>Materials in layers</h2>
      <ul class="choose-material" aria-label="Materials">
        {materials.map(({key, name, is_own}) => <li key={key}><a href={`/material/${encodeURIComponent(key)}/builds`}>{name}</a> <span class="dim">{is_own ? '' : 'comes with weft'}</span></li>)}
      </ul>
    </section>
  );
}

/** An address without maps becomes that of the session's current set. */
export function CurrentMaps({session}: {session: string}) {
  const [hasNone, setHasNone] = useState(false);
  const [complaint, setComplaint] = useState<ApiError | null>(null);
  useLatest((latest) => {
    const ask = () => {
      latest(answer(api.GET('/api/v1/sessions/{name}/maps', {params: {path: {name: session}}}))).then(({current}) => {
        if (current === null) return setHasNone(true);
        become(placeOfMaterial({of: session, is: 'maps', id: current}));
      }, (error: unknown) => setComplaint(asApiError(error)));
    };
    ask();
    return onEvent('job', (job) => job.of === session && job.state === 'done' && ask());
  }, [session]);
  return (
    <section class="page">
      <h1>{clothOf(session)}</h1>
      <Complaint error={complaint} />
      {hasNone && <><p class="dim">No maps were made of this session yet.</p><MakeMaps session={session} /></>}
    </section>
  );
}

/** All maps of the best solve of today's photographs, which the job makes where there are previews alone; or a draft. */
export function MakeMaps({session, onMade}: {session: string; onMade?: () => void}) {
  useJobs();
  const [of, setOf] = useState<Schemas['Session'] | null>(null);
  useLatest((latest) => {
    const ask = () => void latest(answer(api.GET('/api/v1/sessions/{name}', {params: {path: {name: session}}}))).then(setOf, () => {});
    ask();
    return onEvent('job', (job) => job.of === session && job.kind === 'solve' && job.state === 'done' && ask());
  }, [session]);
  useEffect(() => onEvent('job', (job) => job.of === session && job.kind === 'maps' && job.state === 'done' && onMade?.()), [session]);
  const make = useAction(() => queueJob({kind: 'maps', session}));
  const draft = useAction(() => queueJob({kind: 'maps', session, draft: true}));
  const mine = jobs.value.filter((job) => job.of === session && (job.kind === 'maps' || job.kind === 'solve'));
  const running = mine.find((job) => !hasEnded(job));
  const isBusy = make.isBusy || draft.isBusy || running !== undefined;
  const hasPreviewAlone = of?.maps_of === null && of.current_level === 'preview';
  return (
    <>
      {of && <p class="dim">{sourceInWords(of)}</p>}
      <div class="row">
        <Button kind="main" isDisabled={isBusy || of === null} onClick={() => void make.run()}>Make the maps</Button>
        {hasPreviewAlone && <Button kind="quiet" isDisabled={isBusy} onClick={() => void draft.run()}>Only a draft, of the preview</Button>}
      </div>
      <Complaint error={make.complaint ?? draft.complaint} />
      {mine[0] && <JobLine job={running ?? mine[0]} />}
    </>
  );
}

function sourceInWords({maps_of}: Schemas['Session']): string {
  if (maps_of) return [`They are made of the ${maps_of.level} solve ${maps_of.solve.slice(0, 8)}.`, ...maps_of.stale.map((why) => `But ${why}.`)].join(' ');
  return 'Today’s photographs have no solve that is better than a preview: they are solved first.';
}
