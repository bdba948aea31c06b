// SPDX-License-Identifier: Apache-2.0
// For who is here for the first time: a cloth in a moving light, three ways on, and what a solved cloth tells.
import './tour.css';
import type {ComponentChildren} from 'preact';
import {useEffect, useState} from 'preact/hooks';
import {answer, api, asApiError, type ApiError, type Schemas} from '../../api/client';
import {rig} from '../../state/rig';
import {Complaint} from '../../ui/complaint';
import {Copy} from '../../ui/copy';
import {counted} from '../../ui/say';
import {Simulated} from '../jobs/simulated';
import {AskHardCases} from '../jobs/torture';
import {addressOfViewer, FIRST_SIGHT, type Sight} from '../viewer/sight';

type Relit = typeof import('../viewer/viewer_screen')['RelitCloth'];

interface Archive {
  total: number;
  /** The newest session that is solved and good, else one that is solved; none is. */
  session?: Schemas['Summary'];
  solves?: Schemas['Solves'];
}

async function look(): Promise<Archive> {
  const {sessions, total} = await answer(api.GET('/api/v1/sessions', {params: {query: {limit: 100}}}));
  const solved = sessions.filter(({current_solve}) => current_solve !== '');
  const session = solved.find(({verdict}) => verdict.grade === 'good') ?? solved[0];
  const solves = session && (await answer(api.GET('/api/v1/sessions/{name}/solves', {params: {path: {name: session.name}}})));
  return {total, session, solves};
}

function Step({href, says, picture, children}: {href: string; says: string; picture: string; children: ComponentChildren}) {
  return <li><img src={picture} alt="" loading="lazy" /><div><a href={href}>{says}</a><p>{children}</p></div></li>;
}

function ThroughTheCloth({session, solves}: Required<Archive>) {
  const {name, fabric, current_solve} = session;
  const solve = solves.solves.find(({id}) => id === current_solve);
  // A preview has half the size of the truth.
  const other = solves.truth && solve?.method !== 'preview' ? 'truth' : solves.solves.find((each) => each !== solve && each.width === solve?.width)?.id;
  const maps = {session: name, solve: current_solve};
  const seen = (sight: Partial<Sight>) => addressOfViewer(maps, {...FIRST_SIGHT, ...sight});
  const tile = (of: string) => `/api/v1/sessions/${encodeURIComponent(name)}/solves/${current_solve}/tiles/${of}`;
  const centre = {x: Math.floor((solve?.width ?? 0) / 2), y: Math.floor((solve?.height ?? 0) / 2)};
  return (
    <>
      <Step href={seen({})} says="Move the light" picture={tile('relit/top/0_0.jpg?light=0.9,0.1,0.4&exposure=1')}>
        {fabric || name} was photographed by one LED at a time and solved: each pixel has its own normal. Press <kbd>l</kbd> and drag.
      </Step>
      {other && (
        <Step href={seen({other: {session: name, solve: other}, divider: 0.5, panel: 'compare'})} picture={tile(`difference/top/0_0.png?most=2&with=${other}`)}
          says={`Compare it with ${other === 'truth' ? 'the truth' : 'another solve'}`}>
          Drag the divider. <kbd>d</kbd> shows the angle between the two in every pixel.
        </Step>
      )}
      <Step href={seen({pixel: centre, panel: 'pixel'})} says="Ask a pixel" picture={tile('normal/top/0_0.png')}>
        What each photograph read there, what the model makes of it, what was left out and why.
      </Step>
      <Step href="/sessions" says="Find it again" picture={session.thumbnail ?? ''}>
        By words, tags and dates. <a href={`/jobs?price=${encodeURIComponent(name)}`}>Jobs</a> solve it again, and say beforehand what each level costs.
      </Step>
    </>
  );
}

const serve = 'weft serve --rig rig.toml';

function OwnRig() {
  return (
    <div>
      <h2>Connect a rig</h2>
      <p>Plug in camera and LED board, write what they are into rig.toml, and start this page for them. Its <a href="/doctor">doctor</a> says what is still wrong.</p>
      <div class="row"><code>{serve}</code><Copy text={serve} /></div>
    </div>
  );
}

export default function TourScreen() {
  const [archive, setArchive] = useState<Archive | null>(null);
  const [complaint, setComplaint] = useState<ApiError | null>(null);
  const again = () => void look().then(setArchive, (error: unknown) => setComplaint(asApiError(error)));
  const [relit, setRelit] = useState<{RelitCloth: Relit} | null>(null);
  useEffect(again, []);
  useEffect(() => void import('../viewer/viewer_screen').then(setRelit, () => {}), []);
  const hasRig = rig.value?.devices.board.leds !== 0;
  const {session, solves} = archive ?? {};
  const name = session && {session: session.name, solve: session.current_solve};
  return (
    <section class="page tour">
      <h1>A first look</h1>
      <Complaint error={complaint} />
      <div class="first">
        <div>
          {session && name ? (
            <>
              {relit ? <relit.RelitCloth key={name.solve} name={name} says={session.fabric || session.name} /> : <p class="relit" />}
              <p>{session.fabric || session.name}: <a href={`/material/${name.session}`}>see it on a ball</a></p>
            </>
          ) : archive && <p class="relit gingham">No cloth is solved here yet.</p>}
        </div>
        <ul class="ways">
          {hasRig && <li><a class="button main" href="/desk">Scan</a><p>Lay a cloth on the table; the desk says what to press.</p></li>}
          <li>
            <a class="button" href="/sessions">Look</a>
            <p>{archive && counted(archive.total, 'cloth')} in the library, which takes photographs of your own.{!hasRig && ' This server has no rig: it shows archives.'}</p>
          </li>
          <li>
            <Simulated says="Try it without a rig" isMain={!hasRig && !session} onMade={again} />
            <p>A sample cloth in seconds: simulated, solved, a material.</p>
          </li>
          <li><AskHardCases /></li>
        </ul>
      </div>
      {session && solves && <ol><ThroughTheCloth total={0} session={session} solves={solves} /></ol>}
      {!hasRig && <OwnRig />}
    </section>
  );
}
