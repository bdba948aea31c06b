// SPDX-License-Identifier: Apache-2.0
// What is said of the next cloth, and what its scan would be called and take.
import type {Signal} from '@preact/signals';
import {hasTone} from '../../state/tone';
import {Complaint} from '../../ui/complaint';
import {Button} from '../../ui/button';
import {Field} from '../../ui/field';
import {BillView, OtherShots} from './bill';
import {bought, cloth, say} from './cloth';
import {millisecondsOf} from './exposure';
import {blade, bracket, repeats} from './preferences';
import {asked, chosen, proposal, times_us} from './proposal';

export const exposureField = 'exposure';

/** What was typed becomes the time that it stands for. */
function takeNearest(): void {
  const {exposure_us} = chosen.value;
  if (exposure_us !== null && times_us.value.length > 0) say({exposure_ms: millisecondsOf(exposure_us)});
}

/** The name of what a scan would make, or of what it would go on with. */
function Proposed() {
  const {would, refused} = proposal.value;
  if (refused) return <Complaint error={refused} />;
  if (!would) return <p class="dim"><kbd>n</kbd> Say what cloth it is; its session is named after it.</p>;
  return (
    <div class="proposed" role="status">
      <span class="dim">{would.resumed ? `Goes on with (${would.frames ?? 0} of ${would.frames_planned ?? 0} photographs)` : 'Next session'}</span>
      <strong>{would.session}</strong>
      {would.unfinished && <span class="dim">An unfinished one of this cloth is there: {would.unfinished}</span>}
    </div>
  );
}

function Check({says, of}: {says: string; of: Signal<boolean>}) {
  return (
    <label class="check">
      <input type="checkbox" checked={of.value} onChange={(event) => { of.value = event.currentTarget.checked; }} />
      {says}
    </label>
  );
}

/** Kept from cloth to cloth. */
function MoreShots({onSaid}: {onSaid: () => void}) {
  const shots = bought.value;
  return (
    <div class="pair">
      <div>
        {shots ? <strong>{shots.what}</strong> : <Check says="Repeat" of={repeats} />}
        <Check says="Tone at its end" of={hasTone} />
        <Field label="Blade's LED" type="number" placeholder="none" value={blade.value} onInput={(value) => { blade.value = value; }} onEnter={onSaid} />
      </div>
      {shots ? <Button kind="quiet" onClick={() => { bought.value = null; }}>As the rig says</Button> : <Field label="Bracket" type="number" unit="×" placeholder="none" value={bracket.value} onInput={(value) => { bracket.value = value; }} onEnter={onSaid} />}
    </div>
  );
}

export function ClothForm({onSaid}: {onSaid: () => void}) {
  const {fabric, id, tags, height_mm, exposure_ms} = cloth.value;
  return (
    <form class="cloth" onSubmit={(event) => event.preventDefault()}>
      <Field id="fabric" label="Fabric" value={fabric} onInput={(value) => say({fabric: value})} onEnter={onSaid} />
      <Proposed />
      <Field label="Barcode" value={id} onInput={(value) => say({id: value})} onEnter={onSaid} />
      <Field label="Tags" value={tags} placeholder="red, wool" onInput={(value) => say({tags: value})} onEnter={onSaid} />
      <div class="pair">
        <Field label="Height" type="number" unit="mm" placeholder="as the rig" value={height_mm} onInput={(value) => say({height_mm: value})} onEnter={onSaid} />
        <Field id={exposureField} label="Exposure" unit="ms" placeholder="metered" value={exposure_ms} list={times_us.value.map(millisecondsOf)}
          hint={chosen.value.says} isWrong={chosen.value.isWrong} onInput={(value) => say({exposure_ms: value})} onLeave={takeNearest} onEnter={onSaid} />
      </div>
      <MoreShots onSaid={onSaid} />
      {proposal.value.would?.bill && <BillView bill={proposal.value.would.bill} />}
      {proposal.value.would?.bill && <div class="bill"><OtherShots key={JSON.stringify(asked.value)} request={asked.value} /></div>}
    </form>
  );
}
