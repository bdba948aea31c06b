// SPDX-License-Identifier: Apache-2.0
// What is said of a cloth. A change is one step, which can be undone; nobody's change is written over.
import {useState} from 'preact/hooks';
import {formOf as formOfJob} from '../../state/forms';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {Field} from '../../ui/field';
import {wordsOf} from '../../ui/request_schema';
import {change} from './edits';
import {changeBetween, fields, formOf, problemWith, tagsIn, withTags, withoutTag, type Said} from './metadata';
import {tags} from './shelf';

/** Keyed by name and revision: another one begins with what is said then. */
interface MetadataFormProps {
  name: string;
  said: Said;
  onChanged: () => void;
}

export function MetadataForm({name, said, onChanged}: MetadataFormProps) {
  const before = formOf(said);
  const [form, setForm] = useState(before);
  const [typed, type] = useState('');

  const wanted = {...form, tags: withTags(form.tags, tagsIn(typed))};
  const changes = changeBetween(before, wanted);
  const save = useAction(async () => {
    await change(name, {...changes, revision: said.revision});
    type('');
    onChanged();
  });
  const isChanged = Object.keys(changes).length > 0;
  const enter = () => void (isChanged && save.run());
  return (
    <section class="panel metadata" aria-labelledby="metadata-title">
      <h2 id="metadata-title">Cloth</h2>
      {fields.map(({field, label, unit}) => (
        <Field key={field} label={label} unit={unit} value={form[field]} hint={problemWith(field, form[field])} onEnter={enter} list={field === 'kind' ? wordsOf(formOfJob('maps'), 'cloth') : undefined}
          onInput={(value) => setForm({...form, [field]: value})} />
      ))}
      <div class="tags">
        {form.tags.map((tag) => (
          <Button key={tag} label={`Take off the tag ${tag}`} onClick={() => setForm({...form, tags: withoutTag(form.tags, tag)})}>
            {tag} <span aria-hidden="true">×</span>
          </Button>
        ))}
      </div>
      <Field label="New tags" value={typed} onInput={type} onEnter={enter} list={tags.value} placeholder="autumn, red" />
      <div class="row">
        <Button kind="main" isDisabled={!isChanged || save.isBusy} onClick={() => void save.run()}>Save</Button>
        <Button kind="quiet" isDisabled={!isChanged} onClick={() => (setForm(before), type(''))}>As it was</Button>
      </div>
      <Complaint error={save.complaint}>
        {save.complaint?.code === 'changed_meanwhile' && <Button onClick={onChanged}>Show what it is now</Button>}
      </Complaint>
    </section>
  );
}
