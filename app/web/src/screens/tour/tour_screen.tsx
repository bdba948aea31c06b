// SPDX-License-Identifier: Apache-2.0
// For who is here for the first time: through a solved cloth, step by step, to a rig of one's own.
import './tour.css';
import type {ComponentChildren} from 'preact';
import {useEffect, useState} from 'preact/hooks';
import {answer, api, asApiError, type ApiError, type Schemas} from '../../api/client';
import {rig} from '../../state/rig';
import {Complaint} from '../../ui/complaint';
import {Copy} from '../../ui/copy';
import {addressOfViewer, FIRST_SIGHT, type Sight} from '../viewer/sight';

interface Solved {
  session: Schemas['Summary'];
  solves: Schemas['Solves'];
}

/** The newest session that is solved; null: none is. */
async function findSolved(): Promise<Solved | null> {
  const {sessions} = await answer(api.GET('/api/v1/sessions', {params: {query: {limit: 100}}}));
  const session = sessions.find(({current_solve}) => current_solve !== '');
  if (!session) return null;
  const solves = await answer(api.GET('/api/v1/sessions/{name}/solves', {params: {path: {name: session.name}}}));
  return {session, solves};
}

function Step({href, says, children}: {href: string; says: string; children: ComponentChildren}) {
  return <li><a href={href}>{says}</a><p>{children}</p></li>;
}

function ThroughTheCloth({session, solves}: Solved) {
  const {name, fabric, current_solve} = session;
  const solve = solves.solves.find(({id}) => id === current_solve);
  const other = solves.truth ? 'truth' : solves.solves.find(({id}) => id !== current_solve)?.id;
  const seen = (sight: Partial<Sight>) => addressOfViewer({session: name, solve: current_solve}, {...FIRST_SIGHT, ...sight});
  const centre = {x: Math.floor((solve?.width ?? 0) / 2), y: Math.floor((solve?.height ?? 0) / 2)};
  return (
    <>
      <Step href={seen({})} says="Move the light">
        {fabric || name} was photographed by one LED at a time and solved: each pixel has its own normal. Press <kbd>l</kbd> and drag.
      </Step>
      {other && (
        <Step href={seen({other: {session: name, solve: other}, divider: 0.5, panel: 'compare'})} says={`Compare it with ${other === 'truth' ? 'the truth' : 'another solve'}`}>
          Drag the divider. <kbd>d</kbd> shows the angle between the two in every pixel.
        </Step>
      )}
      <Step href={seen({pixel: centre, panel: 'pixel'})} says="Ask a pixel">
        What each photograph read there stands beside what the model makes of it, and what was left out, with the reason.
      </Step>
      <Step href="/sessions" says="Find it again">
        The library knows cloths by words, tags and dates. <a href={`/jobs?price=${encodeURIComponent(name)}`}>Jobs</a> solve them again, and say beforehand what each level costs.
      </Step>
    </>
  );
}

const serve = 'weft serve --rig rig.toml';

function OwnRig() {
  return (
    <li>
      <strong>Connect a rig</strong>
      <p>Plug in camera and LED board, write what they are into rig.toml, and start this page for them.</p>
      <div class="row"><code>{serve}</code><Copy text={serve} /></div>
      <p>Its <a href="/doctor">doctor</a> says what is still wrong, and what mends it. Then it is calibrated, and scans.</p>
    </li>
  );
}

export default function TourScreen() {
  const [solved, setSolved] = useState<Solved | null | undefined>();
  const [complaint, setComplaint] = useState<ApiError | null>(null);
  useEffect(() => {
    findSolved().then(setSolved, (error: unknown) => setComplaint(asApiError(error)));
  }, []);
  const hasRig = rig.value?.devices.board.leds !== 0;
  return (
    <section class="page tour">
      <h1>A first look</h1>
      {!hasRig && <p>This server has no rig: it shows archives. <a href="/sessions">Look at their sessions</a></p>}
      <Complaint error={complaint} />
      {solved === null && <p>No session is solved yet.</p>}
      <ol>
        {solved && <ThroughTheCloth {...solved} />}
        {hasRig ? <Step href="/desk" says="Scan a cloth">Lay it on the table; the desk says what to press.</Step> : <OwnRig />}
      </ol>
    </section>
  );
}
