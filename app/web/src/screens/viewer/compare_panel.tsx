// SPDX-License-Identifier: Apache-2.0
// Two solves beside each other, or the angle between them.
import {useEffect, useState} from 'preact/hooks';
import {answer, api, type Schemas} from '../../api/client';
import {clothOf} from '../../state/cloths';
import {Button} from '../../ui/button';
import {Choice} from '../../ui/choice';
import {degrees} from '../../ui/say';
import {useLatest} from '../../ui/use_latest';
import {percentOf} from '../../ui/words';
import {DIFFERENCES} from './layers';
import {isSameSize, solveInWords} from './maps';
import {solveNameOf, textOf} from './sight';
import type {Viewer} from './viewer';

type Solves = Schemas['Solves'];

async function solvesOf(session: string): Promise<Solves> {
  return answer(api.GET('/api/v1/sessions/{name}/solves', {params: {path: {name: session}}}));
}

async function sessionNames(): Promise<string[]> {
  const page = await answer(api.GET('/api/v1/sessions', {params: {query: {limit: 100}}}));
  return page.sessions.filter(({solves}) => solves > 0).map(({name}) => name);
}

export function optionsOf(session: string, solves: Solves): {value: string; says: string}[] {
  const named = solves.solves.map((solve) => ({value: textOf({session, solve: solve.id}), says: solveInWords(solve)}));
  return solves.truth ? [...named, {value: `${session}/truth`, says: 'truth of the simulation'}] : named;
}

export function useSolves(session: string): Solves | null {
  const [solves, setSolves] = useState<Solves | null>(null);
  useLatest((latest) => {
    setSolves(null);
    latest(solvesOf(session)).then(setSolves, () => setSolves({solves: [], truth: false}));
  }, [session]);
  return solves;
}

function useSessionNames(): string[] {
  const [names, setNames] = useState<string[]>([]);
  useEffect(() => {
    sessionNames().then(setNames, () => setNames([]));
  }, []);
  return names;
}

export function ComparePanel({viewer}: {viewer: Viewer}) {
  const {other} = viewer.sight.value;
  const [session, setSession] = useState(other?.session ?? viewer.name.session);
  const names = useSessionNames();
  const solves = useSolves(session);
  const here = textOf(viewer.name);
  const options = solves ? optionsOf(session, solves).filter(({value}) => value !== here || value === (other && textOf(other))) : [];
  const choose = (text: string) => viewer.see({other: solveNameOf(text), ...(text === '' ? {divider: null} : {})}, 'step');
  return (
    <section>
      <h2>Compare</h2>
      <Choice label="Session compared with" value={session} onChange={setSession}
        options={[...new Set([viewer.name.session, session, ...names])].map((name) => ({value: name, says: clothOf(name) === name ? name : `${clothOf(name)} ${name}`}))} />
      <Choice label="Solve compared with" value={other?.session === session ? textOf(other) : ''} onChange={choose}
        options={[{value: '', says: 'none'}, ...options]} />
      {other && <Ways viewer={viewer} />}
      {other && <Figures viewer={viewer} />}
    </section>
  );
}

/** Why the two cannot be seen beside each other; empty where they can. */
function obstacle(viewer: Viewer): string {
  const maps = viewer.maps.value;
  const other = viewer.other.value;
  if (!maps || !other || isSameSize(maps, other)) return '';
  const sizes = [maps, other].map(({name, solve}) => `${clothOf(name.session)} has ${solve.width} × ${solve.height} pixels`);
  return `${sizes.join(', ')}: solve both at one level.`;
}

export function toggleDivider(viewer: Viewer): void {
  if (!viewer.before.value && (!viewer.other.value || obstacle(viewer))) return;
  viewer.see({divider: viewer.sight.value.divider === null ? 0.5 : null}, 'step');
}

export function toggleDifference(viewer: Viewer, name: string): void {
  if (!viewer.other.value || obstacle(viewer)) return;
  viewer.seeLayer(viewer.sight.value.layer === name ? 'relit' : name);
}

function Ways({viewer}: {viewer: Viewer}) {
  const {divider, layer} = viewer.sight.value;
  const why = obstacle(viewer);
  return (
    <>
      <div class="row">
        <Button keyHint="b" isPressed={divider !== null} isDisabled={why !== ''} onClick={() => toggleDivider(viewer)}>Divider</Button>
        {DIFFERENCES.map(({name, says, key}) => (
          <Button key={name} keyHint={key} isPressed={layer === name} isDisabled={why !== ''} onClick={() => toggleDifference(viewer, name)}>{says}</Button>
        ))}
      </div>
      {why && <p class="dim">{why}</p>}
      <Divider viewer={viewer} says="Divider: this solve left, the other right" />
    </>
  );
}

export function Divider({viewer, says}: {viewer: Viewer; says: string}) {
  const {divider} = viewer.sight.value;
  if (divider === null) return null;
  return (
    <div class="field">
      <label for="divider">{says}</label>
      <input id="divider" type="range" min={0} max={1} step={0.005} value={divider}
        onInput={(event) => viewer.see({divider: event.currentTarget.valueAsNumber})} />
    </div>
  );
}

function Figures({viewer}: {viewer: Viewer}) {
  const figures = viewer.comparison.value;
  if (!figures) return null;
  const {normal, albedo} = figures;
  return (
    <table>
      <caption>This one against the other, over {normal.pixels} pixels</caption>
      <tbody>
        <tr><th scope="row">Normals, mean</th><td class="numbers">{degrees(normal.mean_deg)}</td></tr>
        <tr><th scope="row">median</th><td class="numbers">{degrees(normal.median_deg)}</td></tr>
        <tr><th scope="row">95 % below</th><td class="numbers">{degrees(normal.p95_deg)}</td></tr>
        <tr><th scope="row">largest</th><td class="numbers">{degrees(normal.max_deg)}</td></tr>
        <tr><th scope="row">Albedo, mean difference</th><td class="numbers">{percentOf(albedo.mean_rel)}</td></tr>
        <tr><th scope="row">brighter as a whole</th><td class="numbers">{percentOf(albedo.bias_rel)}</td></tr>
      </tbody>
    </table>
  );
}
