// SPDX-License-Identifier: Apache-2.0
// The begin of a set of photographs: what is laid on the table, in words that the daemon reads, and a button. The set
// keeps the words, so they are needed once.
import {useState} from 'preact/hooks';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {known, workOn} from './state';
import {fromOf, setOf, type Stage, type Walk} from './walk';

type Thing = NonNullable<Stage['thing']>;

/** The last words for each thing: the sheet of the lights is that of the proof. */
const described = new Map<Thing, string>();

export function Begin({walk, stage}: {walk: Walk; stage: Stage}) {
  const {thing, part, about} = stage;
  const [text, setText] = useState(thing ? (described.get(thing) ?? '') : '');
  const begin = useAction(async () => {
    await workOn({part, name: setOf(walk, stage), from: fromOf(walk, stage, known.value), description: text});
    if (thing && text !== '') described.set(thing, text);
  });
  return (
    <form class="begin" onSubmit={(event) => (event.preventDefault(), void begin.run())}>
      <p class="says">{about}</p>
      {thing && <Description thing={thing} text={text} onText={setText} />}
      <div><Button kind="main" type="submit" isDisabled={begin.isBusy}>Begin, or go on with its photographs</Button></div>
      <Complaint error={begin.complaint} />
    </form>
  );
}

interface DescriptionProps {
  thing: Thing;
  text: string;
  onText: (text: string) => void;
}

/** Typed, pasted, or taken from a file. */
function Description({thing, text, onText}: DescriptionProps) {
  const take = async (file: File | undefined) => {
    if (file) onText(await file.text());
  };
  return (
    <fieldset class="description">
      <legend>What the {thing} is: the text of its {thing}.toml. Where the rig knows it already, leave this empty.</legend>
      <label for="description-text">Text of {thing}.toml</label>
      <textarea id="description-text" rows={10} spellcheck={false} value={text} onInput={(event) => onText(event.currentTarget.value)} />
      <label for="description-file">or a file</label>
      <input id="description-file" type="file" accept=".toml,text/plain" onChange={(event) => void take(event.currentTarget.files?.[0])} />
    </fieldset>
  );
}
