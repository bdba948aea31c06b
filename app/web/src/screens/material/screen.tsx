// SPDX-License-Identifier: Apache-2.0
// A cloth as a material: what it looks like, what it is made of, and how it leaves.
import './material.css';
import {useEffect, useMemo} from 'preact/hooks';
import {place} from '../../state/address';
import {Complaint} from '../../ui/complaint';
import {Tabs} from '../../ui/tabs';
import {Choose, NewestMaps} from './choose';
import {ExportPanel} from './export_panel';
import {LayersPanel} from './layers_panel';
import {Look} from './look';
import {LookPanel} from './look_panel';
import {type MaterialName, nameOf, type Panel, PANELS} from './sight';
import {Stage} from './stage';
import {Unbuilt} from './unbuilt';

export default function MaterialScreen() {
  const {parts} = place.value;
  const [of, is] = parts;
  const name = nameOf(parts);
  if (name) return <Viewing key={parts.join('/')} name={name} />;
  if (of === undefined) return <Choose />;
  return is === 'builds' ? <Unbuilt key={of} material={of} /> : <NewestMaps key={of} session={of} />;
}

const panelNames: Record<Panel, string> = {look: 'Look', layers: 'Layers', export: 'Export'};

function Viewing({name}: {name: MaterialName}) {
  const look = useMemo(() => new Look(name), []);
  useEffect(() => () => look.close(), [look]);
  const {panel} = look.sight.value;
  const options = PANELS.filter((each) => each !== 'layers' || name.is === 'builds').map((value) => ({value, says: panelNames[value]}));
  return (
    <div class="material">
      <Stage look={look} />
      <aside aria-label="The material">
        <section>
          <h1>{name.of}</h1>
          <p class="dim">{name.is === 'maps' ? `maps ${name.id.slice(0, 8)}` : `built ${name.id.slice(0, 8)}`}</p>
        </section>
        <Complaint error={look.complaint.value} />
        <Tabs label="Panels" value={panel} options={options} onChange={(to) => look.see({panel: to})}>
          {panel === 'look' && <LookPanel look={look} />}
          {panel === 'layers' && <LayersPanel material={name.of} built={name.id} />}
          {panel === 'export' && <ExportPanel name={name} />}
        </Tabs>
      </aside>
    </div>
  );
}
