// SPDX-License-Identifier: Apache-2.0
// How the material leaves: presets with what they write and lose, and the files that were made.
import {useEffect, useState} from 'preact/hooks';
import {answer, api, type ApiError, asApiError, fetched, type Schemas} from '../../api/client';
import {onEvent} from '../../api/events';
import {formOf} from '../../state/forms';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {Copy} from '../../ui/copy';
import {Mark} from '../../ui/mark';
import type {Wish} from '../../ui/request_schema';
import {More} from '../../ui/schema_form';
import {useLatest} from '../../ui/use_latest';
import {bytesOf} from '../../ui/words';
import {jobs, queueJob, useJobs} from '../jobs/jobs';
import {hasEnded} from '../jobs/queue';
import {addressOfExports, addressOfFile, type ExportFile, type ExportPrice, filesOf, priceInWords, pricesOf, requestOf} from './exports';
import {JobLine} from './job_line';
import type {MaterialName} from './material_sight';

const saidHere = ['session', 'material', 'set', 'presets', 'draft'];

export function ExportPanel({name, isDraft}: {name: MaterialName; isDraft: boolean}) {
  useJobs();
  const [presets, setPresets] = useState<Schemas['Preset'][]>([]);
  const [takesDraft, setTakesDraft] = useState(false);
  const [chosen, setChosen] = useState<string[]>([]);
  const [wish, setWish] = useState<Wish>({});
  const [complaint, setComplaint] = useState<ApiError | null>(null);
  useEffect(() => {
    answer(api.GET('/api/v1/presets')).then((list) => setPresets(list.presets), (error: unknown) => setComplaint(asApiError(error)));
  }, []);
  const price = useAction(() => queueJob({...requestOf('export_price', name, chosen, isDraft && takesDraft), ...wish}));
  const make = useAction(() => queueJob({...requestOf('export', name, chosen, isDraft && takesDraft), ...wish}));
  const newest = (kind: string) => jobs.value.find((job) => job.kind === kind && job.of === name.of && job.wants.set === name.id);
  const prices = pricesOf(newest('export_price')?.result);
  const formats = prices.get('');
  const isRunning = (kind: string) => newest(kind)?.state !== undefined && !hasEnded(newest(kind)!);
  const toggle = (preset: string) => setChosen(chosen.includes(preset) ? chosen.filter((each) => each !== preset) : [...chosen, preset]);
  return (
    <>
      <section>
        <h2>Presets</h2>
        <Complaint error={complaint ?? price.complaint ?? make.complaint} />
        <ul class="presets" aria-label="Presets">
          {presets.map((preset) => (
            <Preset key={preset.name} preset={preset} isChosen={chosen.includes(preset.name)} price={prices.get(preset.name)} onToggle={() => toggle(preset.name)} />
          ))}
        </ul>
        {isDraft && (
          <label>
            <input type="checkbox" checked={takesDraft} onChange={(event) => setTakesDraft(event.currentTarget.checked)} />
            {' '}Export the draft: it is of a preview, of half the size and without masks
          </label>
        )}
        <More of="the export" schema={formOf('export')} wish={wish} onWish={setWish} without={saidHere} />
        <div class="row sticky">
          <Button isDisabled={chosen.length === 0 || price.isBusy || isRunning('export_price')} onClick={() => void price.run()}>What it costs</Button>
          <Button kind="main" isDisabled={chosen.length === 0 || make.isBusy || isRunning('export')} onClick={() => void make.run()}>Export</Button>
        </div>
        {formats && (
          <details>
            <summary>Normals and albedo in every format</summary>
            <Files files={formats.files} />
          </details>
        )}
        {(['export_price', 'export'] as const).map((kind) => newest(kind) && <JobLine key={kind} job={newest(kind)!} />)}
      </section>
      <Exported name={name} />
    </>
  );
}

interface PresetProps {
  preset: Schemas['Preset'];
  isChosen: boolean;
  price: ExportPrice | undefined;
  onToggle: () => void;
}

function Preset({preset: {name, says, is_own, files, fault}, isChosen, price, onToggle}: PresetProps) {
  return (
    <li data-preset={name}>
      <label>
        <input type="checkbox" checked={isChosen} disabled={fault !== ''} onChange={onToggle} aria-label={name} />
        <span><span class="says">{name}</span>{is_own ? ' (your own)' : ''} <span class="dim">{says}</span></span>
        {price && <span class="numbers">{priceInWords(price)}</span>}
      </label>
      {fault !== '' && <Mark verdict="fault">{fault}</Mark>}
      {isChosen && !price && <span class="dim">{files.join(', ')}</span>}
      {isChosen && price && <Files files={price.files} />}
    </li>
  );
}

/** With `address` they can be downloaded. */
function Files({files, address}: {files: readonly ExportFile[]; address?: (file: string) => string}) {
  return (
    <ul class="files">
      {files.map(({file, bytes, says}, index) => (
        <li key={index}>
          <span>{address ? <a href={address(file)} download={file.split('/').pop()}>{file}</a> : file} <span class="dim">{says}</span></span>
          {bytes !== null && <span class="numbers">{bytesOf(bytes)}</span>}
        </li>
      ))}
    </ul>
  );
}

function Exported({name}: {name: MaterialName}) {
  const [made, setMade] = useState<Schemas['Exported'][]>([]);
  useLatest((latest) => {
    const list = async () => ((await (await fetched(addressOfExports(name))).json()) as Schemas['Exports']).exports;
    const ask = () => void latest(list()).then(setMade, () => {});
    ask();
    return onEvent('job', (job) => job.kind === 'export' && job.state === 'done' && ask());
  }, [name]);
  if (made.length === 0) return null;
  return (
    <section>
      <h2>Exported</h2>
      {made.map(({preset, folder, document}) => (
        <div key={preset} class="exported" data-preset={preset}>
          <h3>{preset}</h3>
          <Files files={onDisk(document)} address={(file) => addressOfFile(name, preset, file)} />
          <div class="row"><span class="dim folder">{folder}</span><Copy text={folder} what="Copy the folder" /></div>
        </div>
      ))}
    </section>
  );
}

/** Documents that hold their textures leave no others beside them. */
function onDisk(document: unknown): ExportFile[] {
  return filesOf(document).filter(({bytes}) => bytes !== null && bytes > 0);
}
