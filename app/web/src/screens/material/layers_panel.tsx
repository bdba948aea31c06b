// SPDX-License-Identifier: Apache-2.0
// The layers of a material, and its builds.
import {useEffect, useState} from 'preact/hooks';
import {answer, api, type ApiError, asApiError, type Schemas} from '../../api/client';
import {go} from '../../state/address';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {Field} from '../../ui/field';
import {Mark} from '../../ui/mark';
import {Table} from '../../ui/table';
import {percentOf} from '../../ui/words';
import {jobs, queueJob, useJobs} from '../jobs/jobs';
import {hasEnded} from '../jobs/queue';
import {JobLine} from './job_line';
import {placeOfMaterial} from './material_sight';
import {Slider} from './slider';
import {builtBy, fileName, type LayerWish, type MaterialValue, movedBy, ownValues, requestOf, stackOf, type StackLayer, valueInWords, wishesOf} from './stack';

/** `built`: the id of the build that is looked at; empty: none. */
export function LayersPanel({material, built}: {material: string; built: string}) {
  const [resolved, setResolved] = useState<Schemas['ResolvedMaterial'] | null>(null);
  const [complaint, setComplaint] = useState<ApiError | null>(null);
  useEffect(() => {
    answer(api.GET('/api/v1/materials/{name}', {params: {path: {name: material}}})).then(setResolved, (error: unknown) => setComplaint(asApiError(error)));
  }, [material]);
  return (
    <section>
      <h2>Layers</h2>
      <Complaint error={complaint} />
      {resolved && (
        <>
          <Build material={material} built={built} />
          {resolved.layers.length === 0 && <p class="dim">No layers: one surface.</p>}
          <Stack key={material} material={material} stack={stackOf(resolved)} />
          <p class="dim">{resolved.generations.map(fileName).join(' inherits ')}</p>
          <Values caption="Values of the material" values={ownValues(resolved)} />
        </>
      )}
    </section>
  );
}

/** Layers that are changed become a material of their own, which inherits this one. */
function Stack({material, stack}: {material: string; stack: StackLayer[]}) {
  const [wishes, setWishes] = useState(() => wishesOf(stack));
  const [name, setName] = useState('');
  const save = useAction(async () => {
    const {key} = await answer(api.POST('/api/v1/materials', {body: requestOf(name, material, wishes, stack)}));
    go(`/material/${encodeURIComponent(key)}/builds`);
  });
  const isChanged = JSON.stringify(wishes) !== JSON.stringify(wishesOf(stack));
  return (
    <>
      <ol class="stack" aria-label="Layers, the top one first">
        {wishes.map((wish, index) => {
          const layer = stack.find((each) => each.name === wish.name);
          const change = (to: Partial<LayerWish>) => setWishes(wishes.map((each) => (each === wish ? {...each, ...to} : each)));
          return layer && (
            <Layer key={wish.name} layer={layer} wish={wish} onChange={change}
              onMove={wishes.length > 1 ? (by) => setWishes(movedBy(wishes, index, by)) : null} />
          );
        })}
      </ol>
      {isChanged && (
        <form class="row" onSubmit={(event) => (event.preventDefault(), void save.run())}>
          <Field label="Save as" value={name} onInput={setName} hint="A material of the library that inherits this one." />
          <Button type="submit" kind="main" isDisabled={name === '' || save.isBusy}>Save</Button>
          <Button kind="quiet" onClick={() => setWishes(wishesOf(stack))}>As its files say</Button>
        </form>
      )}
      <Complaint error={save.complaint} />
    </>
  );
}

interface LayerProps {
  layer: StackLayer;
  wish: LayerWish;
  onChange: (to: Partial<LayerWish>) => void;
  onMove: ((by: -1 | 1) => void) | null;
}

function Layer({layer: {name, material, mask, blend, from, values}, wish: {alpha, isOn}, onChange, onMove}: LayerProps) {
  return (
    <li class={isOn ? '' : 'dim'}>
      <div class="row">
        <label><input type="checkbox" checked={isOn} aria-label={`${name} is on`} onChange={() => onChange({isOn: !isOn, alpha: alpha === 0 ? 1 : alpha})} /> <span class="says">{name}</span></label>
        {onMove && (
          <span class="row">
            <Button kind="quiet" label={`${name} higher`} onClick={() => onMove(-1)}>↑</Button>
            <Button kind="quiet" label={`${name} lower`} onClick={() => onMove(1)}>↓</Button>
          </span>
        )}
      </div>
      <Slider label={`Strength of ${name}`} value={isOn ? alpha : 0} ends={[0, 1]} says={isOn ? percentOf(alpha) : 'off'} onChange={(to) => onChange({alpha: to, isOn: to > 0})} />
      <span>{material}{blend === 'replace' ? '' : `, as ${blend}`}</span>
      <span class="dim">mask: {mask}</span>
      <span class="dim">from {from.join(', ')}</span>
      <Values caption={`Values of ${name}`} values={values} />
    </li>
  );
}

function Values({caption, values}: {caption: string; values: readonly MaterialValue[]}) {
  return (
    <details>
      <summary>{caption}</summary>
      <Table caption={caption} heads={['Key', 'Value', 'From']}
        rows={values.map(({key, value, from}) => ({key, cells: [key, valueInWords(value), <span title={from}>{fileName(from)}</span>]}))} />
    </details>
  );
}

function Build({material, built}: {material: string; built: string}) {
  useJobs();
  const build = useAction(() => queueJob({kind: 'material', material}));
  const job = jobs.value.find(({kind, of}) => kind === 'material' && of === material);
  const id = job?.state === 'done' ? builtBy(job.result) : '';
  return (
    <>
      <div class="row">
        <Button kind="main" isDisabled={build.isBusy || (job !== undefined && !hasEnded(job))} onClick={() => void build.run()}>Build</Button>
        {id !== '' && id !== built && <Button onClick={() => go(placeOfMaterial({of: material, is: 'builds', id}, 'layers'))}>Look at it</Button>}
        {id !== '' && id === built && <Mark verdict="fine">this is what its files say</Mark>}
      </div>
      <Complaint error={build.complaint} />
      {job && <JobLine job={job} />}
    </>
  );
}
