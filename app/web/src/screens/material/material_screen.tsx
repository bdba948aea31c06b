// SPDX-License-Identifier: Apache-2.0
// A cloth as a material: what it looks like, what it is made of, and how it leaves.
import './material.css';
import {useEffect, useMemo, useState} from 'preact/hooks';
import {answer, api, type ApiError, asApiError, type Schemas} from '../../api/client';
import {go, place} from '../../state/address';
import {Complaint} from '../../ui/complaint';
import {fieldsOf, listIn, textIn} from '../../ui/fields';
import {Tabs} from '../../ui/tabs';
import {timeOf} from '../../ui/words';
import {Choose, CurrentMaps, MakeMaps} from './choose';
import {ExportPanel} from './export_panel';
import {LayersPanel} from './layers_panel';
import {Look} from './look';
import {LookPanel} from './look_panel';
import {MATERIAL_PANELS, type MaterialName, type MaterialPanel, nameOf, placeOfMaterial} from './material_sight';
import {Stage} from './stage';
import {titleOf} from './title';

export default function MaterialScreen() {
  const {parts} = place.value;
  const [of, is] = parts;
  const name = nameOf(parts);
  if (name) return <Viewing key={parts.join('/')} name={name} />;
  if (of === undefined) return <Choose />;
  return is === 'builds' ? <Unbuilt key={of} material={of} /> : <CurrentMaps key={of} session={of} />;
}

const panelNames: Record<MaterialPanel, string> = {look: 'Look', layers: 'Layers', export: 'Export'};

function Viewing({name}: {name: MaterialName}) {
  const look = useMemo(() => new Look(name), []);
  useEffect(() => () => look.close(), [look]);
  const {panel} = look.sight.value;
  const options = MATERIAL_PANELS.filter((each) => each !== 'layers' || name.is === 'builds').map((value) => ({value, says: panelNames[value]}));
  return (
    <div class="material">
      <Stage look={look} />
      <aside aria-label="The material">
        <section>
          <h1>{titleOf(name)}</h1>
          {titleOf(name) !== name.of && <p class="dim">{name.of}</p>}
          <p class="dim">{name.is === 'maps' ? `maps ${name.id.slice(0, 8)}` : `built ${name.id.slice(0, 8)}`}</p>
          <Source look={look} />
        </section>
        <Complaint error={look.complaint.value} />
        <Tabs label="Panels" value={panel} options={options} onChange={(to) => look.see({panel: to})}>
          {panel === 'look' && <LookPanel look={look} />}
          {panel === 'layers' && <LayersPanel material={name.of} built={name.id} />}
          {panel === 'export' && <ExportPanel name={name} isDraft={fieldsOf(look.document.value)['draft'] === true} />}
        </Tabs>
      </aside>
    </div>
  );
}

/** Which solves it is made of, what is stale of them, and the way to newer maps. */
function Source({look}: {look: Look}) {
  const viewed = look.viewed.value;
  if (!viewed) return null;
  const isDraft = fieldsOf(viewed.set)['draft'] === true;
  return (
    <>
      {sourcesOf(viewed.set).map((says) => <p key={says} class="dim">{says}</p>)}
      {isDraft && <p class="warning">▲ A draft: of a preview, of half the size and without masks</p>}
      {viewed.stale.map((why) => <p key={why} class="warning">▲ Stale: {why}</p>)}
      {look.name.is === 'maps' && (isDraft || viewed.stale.length > 0) && <MakeMaps session={look.name.of} onMade={() => go(`/material/${look.name.of}`)} />}
    </>
  );
}

/** "standard solve 1c0f22aa", of a set; of what was built a line for each scan. */
function sourcesOf(set: unknown): string[] {
  const scans = listIn(set, 'scans');
  const inWords = (of: unknown) => `${textIn(of, 'level')} solve ${textIn(of, 'solve').slice(0, 8)}`.trim();
  if (scans.length > 0) return [...new Set(scans.map((scan) => `${textIn(scan, 'session')}: ${inWords(scan)}`))];
  return textIn(set, 'solve') === '' ? [] : [inWords(set)];
}

/** A material by its files, with what was built of it. */
function Unbuilt({material}: {material: string}) {
  const [builds, setBuilds] = useState<Schemas['Builds']['builds']>([]);
  const [complaint, setComplaint] = useState<ApiError | null>(null);
  useEffect(() => {
    answer(api.GET('/api/v1/materials/{name}/builds', {params: {path: {name: material}}})).then(
      (list) => setBuilds(list.builds), (error: unknown) => setComplaint(asApiError(error)),
    );
  }, [material]);
  return (
    <section class="page material-files">
      <h1>{material}</h1>
      <Complaint error={complaint} />
      <LayersPanel material={material} built="" />
      <h2>Builds</h2>
      {builds.length === 0 && <p class="dim">None yet.</p>}
      <ul class="choose-material" aria-label="Builds">
        {builds.map(({id, created}) => <li key={id}><a href={placeOfMaterial({of: material, is: 'builds', id})}>{id.slice(0, 8)}</a> <span class="dim">{timeOf(created)}</span></li>)}
      </ul>
    </section>
  );
}
