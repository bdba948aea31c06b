// SPDX-License-Identifier: Apache-2.0
// Which material: a cloth that was scanned, or one that is written as layers. Maps that are not there yet are made here.
import {useEffect, useState} from 'preact/hooks';
import {answer, api, type ApiError, asApiError, type Schemas} from '../../api/client';
import {onEvent} from '../../api/events';
import {place} from '../../state/address';
import {placeOf} from '../../state/place';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {Empty} from '../../ui/empty';
import {hasEnded} from '../jobs/queue';
import {jobs, queueJob, useJobs} from '../jobs/state';
import {JobLine} from './job_line';
import {placeOfMaterial} from './sight';

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
      {sessions?.length === 0 && <Empty says="No cloth is scanned yet."><p>Scan one at the <a href="/desk">desk</a>.</p></Empty>}
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

/** An address without maps becomes that of the session's newest. */
export function NewestMaps({session}: {session: string}) {
  const [hasNone, setHasNone] = useState(false);
  const [complaint, setComplaint] = useState<ApiError | null>(null);
  useEffect(() => {
    const ask = () => {
      answer(api.GET('/api/v1/sessions/{name}/maps', {params: {path: {name: session}}})).then(({sets}) => {
        const newest = sets.find(({preview}) => !preview);
        if (!newest) return setHasNone(true);
        history.replaceState(null, '', placeOfMaterial({of: session, is: 'maps', id: newest.id}) + location.search);
        place.value = placeOf(new URL(location.href));
      }, (error: unknown) => setComplaint(asApiError(error)));
    };
    ask();
    return onEvent('job', (job) => job.of === session && job.state === 'done' && ask());
  }, [session]);
  return (
    <section class="page">
      <h1>{session}</h1>
      <Complaint error={complaint} />
      {hasNone && <MakeMaps session={session} />}
    </section>
  );
}

/** The solve, where there is none, and all maps of it. */
function MakeMaps({session}: {session: string}) {
  useJobs();
  const make = useAction(async () => {
    const {solves} = await answer(api.GET('/api/v1/sessions/{name}/solves', {params: {path: {name: session}}}));
    if (solves.length === 0) await queueJob({kind: 'solve', session, quality: 'standard'});
    await queueJob({kind: 'maps', session});
  });
  const mine = jobs.value.filter(({of, kind}) => of === session && (kind === 'maps' || kind === 'solve'));
  const running = mine.find((job) => !hasEnded(job));
  return (
    <>
      <p class="dim">A material is made of maps: normals, albedo, height, occlusion, roughness. None were made of this session yet.</p>
      <div class="row"><Button kind="main" isDisabled={make.isBusy || running !== undefined} onClick={() => void make.run()}>Make the maps</Button></div>
      <Complaint error={make.complaint} />
      {mine[0] && <JobLine job={running ?? mine[0]} />}
    </>
  );
}
