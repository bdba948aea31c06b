// SPDX-License-Identifier: Apache-2.0
import './viewer.css';
import {useEffect, useMemo, useState} from 'preact/hooks';
import {answer, api, ApiError, asApiError} from '../../api/client';
import {become, go, place} from '../../state/address';
import {clothOf} from '../../state/cloths';
import {Choice} from '../../ui/choice';
import {Complaint} from '../../ui/complaint';
import {Tabs} from '../../ui/tabs';
import {useLatest} from '../../ui/use_latest';
import {MadePanel} from '../finish/found';
import {FinishPanel} from '../finish/panel';
import {zoomInWords} from './bars';
import type {PictureCanvas} from './canvas';
import {ComparePanel, optionsOf, useSolves} from './compare_panel';
import {LayerPanel} from './layer_panel';
import {saysOf} from './layers';
import {lightInWords} from './light';
import {LightPanel} from './light_panel';
import {NoSession} from './no_session';
import {Picture} from './picture';
import {PixelPanel} from './pixel_panel';
import {valuesOf} from './probe';
import {RegionPanel} from './region_panel';
import {RulerPanel} from './ruler_panel';
import {optionOf, useSets} from './sets';
import {addressOfViewer, nameOf, solveNameOf, type SolveName, textOf, VIEWER_PANELS, type ViewerPanel} from './sight';
import {Toolbar, useViewerKeys} from './toolbar';
import {Viewer} from './viewer';
import {WhyPanel} from './why_panel';

export {RelitCloth} from './relit_cloth';

export default function ViewerScreen() {
  const {parts} = place.value;
  const [session] = parts;
  if (session === undefined) return <NoSession />;
  const name = nameOf(parts);
  return name ? <Viewing key={session} name={name} /> : <CurrentSolve key={session} session={session} />;
}

function noSolveOf(session: string): ApiError {
  return new ApiError('There is nothing to look at yet.', session, 'This session was not solved.', 'Queue a solve under Jobs.', 404);
}

/** An address without a solve becomes that of the session's current one. */
function CurrentSolve({session}: {session: string}) {
  const [complaint, setComplaint] = useState<ApiError | null>(null);
  useLatest((latest) => {
    latest(answer(api.GET('/api/v1/sessions/{name}/solves', {params: {path: {name: session}}}))).then(({solves, truth}) => {
      const solve = solves.find(({is_current}) => is_current)?.id ?? (truth ? 'truth' : null);
      if (solve === null) return setComplaint(noSolveOf(session));
      become(addressOfViewer({session, solve}));
    }, (error: unknown) => setComplaint(asApiError(error)));
  }, [session]);
  return <section class="page"><h1>{clothOf(session)}</h1><Complaint error={complaint} /></section>;
}

/** The session beside this one in the library, with its solve. */
async function neighbour(session: string, step: 1 | -1): Promise<SolveName | null> {
  const page = await answer(api.GET('/api/v1/sessions', {params: {query: {limit: 1000}}}));
  const all = page.sessions.filter(({current_solve}) => current_solve !== '');
  const next = all[all.findIndex(({name}) => name === session) + step];
  return next ? {session: next.name, solve: next.current_solve} : null;
}

function Viewing({name}: {name: SolveName}) {
  const words = textOf(name);
  const viewer = useMemo(() => new Viewer(name), [words]);
  const [picture, setPicture] = useState<PictureCanvas | null>(null);
  useEffect(() => () => viewer.close(), [viewer]);
  const turn = (step: 1 | -1) => {
    const from = place.peek();
    neighbour(name.session, step).then(
      (next) => next && place.peek() === from && go(addressOfViewer(next)),
      (error: unknown) => (viewer.complaint.value = asApiError(error)),
    );
  };
  useViewerKeys(viewer, {previous: () => turn(-1), next: () => turn(1)});
  return (
    <div class="viewer">
      <div class="stage">
        <Toolbar viewer={viewer} picture={picture} />
        <Picture key={words} viewer={viewer} onCanvas={setPicture} />
        <StatusLine viewer={viewer} />
      </div>
      <aside aria-label="What is seen">
        <Head viewer={viewer} />
        <Complaint error={viewer.complaint.value} />
        <Tabs label="Panels" value={viewer.panel.value} options={panelsOf(name)} onChange={(panel) => viewer.see({panel})}>
          <Chosen key={viewer.panel.value === 'finish' ? '' : words} viewer={viewer} panel={viewer.panel.value} />
        </Tabs>
      </aside>
    </div>
  );
}

/** What the canvas shows and what is known of the pixel that is asked about, in one line. */
function StatusLine({viewer}: {viewer: Viewer}) {
  const {layer, light, exposure} = viewer.sight.value;
  const view = viewer.view.value;
  const pixel = viewer.pixel.value;
  const pencil = viewer.pencil.value;
  const lit = layer === 'relit' ? ` ${lightInWords(light)}` : '';
  const brighter = exposure === 0 ? '' : `, ${exposure > 0 ? '+' : ''}${exposure.toFixed(1)} stops`;
  const numbers = (name: string) => (pixel ? valuesOf(pixel, name).map((value) => Number(value).toFixed(3)).join(' ') : '');
  return (
    <div class="status-line numbers">
      <span role="status">{saysOf(layer)}{lit}{brighter}{view && `, ${zoomInWords(view.zoom)}`}{pencil && `, mark at ${Math.floor(pencil.at.x)}, ${Math.floor(pencil.at.y)}`}</span>
      {pixel && (
        <span>
          {pixel.x}, {pixel.y} <span class="dim">normal</span> {numbers('normal')} <span class="dim">albedo</span> {numbers('albedo')}
        </span>
      )}
    </div>
  );
}

const names: Record<ViewerPanel, string> = {look: 'Look', pixel: 'Pixel', measure: 'Measure', compare: 'Compare', why: 'Why', finish: 'Finish'};

/** A set of maps lies on a grid of its own, so that it is compared with no other. */
function panelsOf({isSet}: SolveName) {
  return VIEWER_PANELS.filter((panel) => !(isSet && panel === 'compare')).map((value) => ({value, says: names[value]}));
}

function Chosen({viewer, panel}: {viewer: Viewer; panel: ViewerPanel}) {
  switch (panel) {
    case 'look':
      return <><LayerPanel viewer={viewer} /><LightPanel viewer={viewer} /></>;
    case 'pixel':
      return <PixelPanel viewer={viewer} />;
    case 'measure':
      return <><MeasureHint viewer={viewer} /><RulerPanel viewer={viewer} /><RegionPanel viewer={viewer} /></>;
    case 'compare':
      return <ComparePanel viewer={viewer} />;
    case 'why':
      return viewer.name.isSet ? <MadePanel of={viewer.name} document={viewer.maps.value?.solve.set} /> : <WhyPanel viewer={viewer} />;
    case 'finish':
      return <FinishPanel viewer={viewer} />;
  }
}

function MeasureHint({viewer}: {viewer: Viewer}) {
  const {line, box} = viewer.sight.value;
  if (line || box) return null;
  return (
    <section>
      <p class="dim">Drag the ruler from end to end, or the rectangle over a part of the cloth. Arrows lead the mark, Shift farther, Enter sets an end.</p>
    </section>
  );
}

function Head({viewer}: {viewer: Viewer}) {
  const {session} = viewer.name;
  const solves = useSolves(session);
  const sets = useSets(session);
  const maps = viewer.maps.value;
  const options = [...optionsOf(session, solves ?? {solves: [], truth: false}), ...sets.map((set) => optionOf(session, set))];
  const choose = (text: string) => {
    const chosen = solveNameOf(text);
    if (chosen) go(addressOfViewer(chosen) + location.search);
  };
  return (
    <section class="head">
      <div class="row">
        <h1>{clothOf(session)}</h1>
        {solves && (
          <Choice label="Solve" value={textOf(viewer.name)} options={options} onChange={choose} />
        )}
      </div>
      {clothOf(session) !== session && <p class="dim">{session}</p>}
      {maps && (
        <p class="dim numbers">
          {maps.solve.width} × {maps.solve.height} pixels
          {maps.solve.mm_per_pixel != null && `, ${maps.solve.mm_per_pixel.toFixed(4)} mm a pixel`}
          {maps.solve.albedo_scale === 'relative' && ', albedo without an absolute scale'}
        </p>
      )}
      {viewer.name.isSet && <a href={`/material/${textOf(viewer.name)}`}>As a material</a>}
      {maps?.solve.stale.map((why) => <p key={why} class="warning">▲ Stale: {why}</p>)}
      {maps?.solve.warnings.map((warning) => <p key={warning} class="warning">▲ {warning}</p>)}
    </section>
  );
}
