// SPDX-License-Identifier: Apache-2.0
// The begin of a set of photographs: what is laid on the table, and a button. The set keeps it, so it is said once.
import {useState} from 'preact/hooks';
import {answer, api, type Schemas} from '../../api/client';
import {forms} from '../../state/forms';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {schemaOf, type Wish} from '../../ui/request_schema';
import {SchemaForm} from '../../ui/schema_form';
import {known, workOn} from './calibrations';
import {fromOf, setOf, type Walk, type WalkStage} from './walk';

type Thing = NonNullable<WalkStage['thing']>;
interface Described {
  wish: Wish;
  /** What a file says in place of the form; empty: none was chosen. */
  text: string;
}

const nothing: Described = {wish: {}, text: ''};
/** What was said last of each thing: the sheet of the lights is that of the proof. */
const described = new Map<Thing, Described>();

export function Begin({walk, stage}: {walk: Walk; stage: WalkStage}) {
  const {thing, part, about} = stage;
  const [said, say] = useState((thing && described.get(thing)) ?? nothing);
  const begin = useAction(async () => {
    const isSaid = Object.keys(said.wish).length > 0;
    await workOn({part, name: setOf(walk, stage), from: fromOf(walk, stage, known.value), thing: said.text || (isSaid ? said.wish : null)});
    if (thing) described.set(thing, said);
  });
  return (
    <form class="begin" onSubmit={(event) => (event.preventDefault(), void begin.run())}>
      <p class="says">{about}</p>
      {thing && <Description thing={thing} said={said} onSaid={say} />}
      <div><Button kind="main" type="submit" isDisabled={begin.isBusy}>Begin, or go on with its photographs</Button></div>
      <Complaint error={begin.complaint} />
    </form>
  );
}

interface DescriptionProps {
  thing: Thing;
  said: Described;
  onSaid: (said: Described) => void;
}

/** Field by field, or taken from a file. */
function Description({thing, said, onSaid}: DescriptionProps) {
  const take = async (file: File | undefined) => {
    if (file) onSaid({wish: {}, text: await file.text()});
  };
  const [printed, setPrinted] = useState<Schemas['PrintedTarget'] | null>(null);
  const print = useAction(async () => {
    setPrinted(await answer(api.POST('/api/v1/calibrations/targets', {body: {target: thing as 'board'}})));
  });
  return (
    <fieldset class="description">
      <legend>What the {thing} is. Where the rig knows it already, or printed it, leave this empty.</legend>
      {thing !== 'chart' && <div><Button kind="quiet" onClick={() => void print.run()}>Print a {thing}</Button></div>}
      {printed && <p><a href={printed.pdf} target="_blank">{printed.says}</a>: {printed.remedy}.</p>}
      <Complaint error={print.complaint} />
      {said.text === '' && <SchemaForm schema={schemaOf(forms.value.things[thing])} wish={said.wish} onWish={(wish) => onSaid({wish, text: ''})} prefix={`${thing}-`} />}
      {said.text !== '' && <><pre>{said.text}</pre><div><Button kind="quiet" onClick={() => onSaid(nothing)}>Say it field by field</Button></div></>}
      <label for="description-file">{said.text === '' ? 'Or its file' : 'Its file'}, {thing}.toml</label>
      <input id="description-file" type="file" accept=".toml,text/plain" onChange={(event) => void take(event.currentTarget.files?.[0])} />
    </fieldset>
  );
}
