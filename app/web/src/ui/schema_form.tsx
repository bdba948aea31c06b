// SPDX-License-Identifier: Apache-2.0
// A form that is drawn from what a request may say.
import {useState} from 'preact/hooks';
import {Button} from './button';
import {Choice} from './choice';
import {Field} from './field';
import {type FieldValue, isWrong, keptBy, labelOf, rangeInWords, type Schema, type SchemaField, valueOf, type Wish, withValue} from './request_schema';

interface SchemaFormProps {
  schema: Schema;
  wish: Wish;
  onWish: (wish: Wish) => void;
  /** Fields that the screen says itself. */
  without?: readonly string[];
  /** Begins the names of its fields: several such forms may be shown at once. */
  prefix?: string;
}

export function SchemaForm({schema, wish, onWish, without = [], prefix = 'option-'}: SchemaFormProps) {
  const said = [...without, ...Object.keys(wish)];
  return (
    <div class="schema-form">
      {schema.fields.filter(({name}) => !without.includes(name)).map((field) => (
        <Line key={field.name} id={`${prefix}${field.name}`} field={field} value={wish[field.name]} keeper={keptBy(schema, field.name, said)}
          onValue={(value) => onWish(withValue(wish, field.name, value))} />
      ))}
    </div>
  );
}

interface LineProps {
  id: string;
  field: SchemaField;
  value: FieldValue | undefined;
  /** Another field that was said in its place. */
  keeper: string | null;
  onValue: (value: FieldValue | null) => void;
}

function Line({id, field, value, keeper, onValue}: LineProps) {
  const {label, unit} = labelOf(field);
  const [text, setText] = useState(value === undefined ? '' : String(value));
  if (field.holds === 'flag') {
    return (
      <label class="flag">
        <input type="checkbox" checked={Boolean(value ?? field.otherwise)} disabled={keeper !== null}
          onChange={(event) => onValue(event.currentTarget.checked === field.otherwise ? null : event.currentTarget.checked)} />
        {' '}{label} <span class="dim">{field.says}</span>
      </label>
    );
  }
  if (field.holds === 'word') {
    const unsaid = field.otherwise === null ? 'as it is' : String(field.otherwise);
    const options = [{value: '', says: unsaid}, ...field.words.filter((word) => word !== field.otherwise).map((word) => ({value: word, says: word}))];
    return <Choice label={label} says={field.says} value={String(value ?? '')} options={options} onChange={(word) => onValue(word === '' ? null : word)} />;
  }
  if (field.each) return <List field={field} schema={field.each} values={(value ?? []) as Wish[]} onValue={onValue} />;
  const range = rangeInWords(field);
  const type = (text: string) => {
    setText(text);
    onValue(valueOf(field, text));
  };
  return (
    <Field id={id} label={label} unit={unit} value={text} onInput={type} isDisabled={keeper !== null} isWrong={isWrong(field, value)}
      placeholder={field.otherwise === null ? undefined : String(field.otherwise)}
      hint={keeper !== null ? `${labelOf({name: keeper}).label} is said in its place.` : [field.says, range].filter(Boolean).join('; ')} />
  );
}

interface ListProps {
  field: SchemaField;
  schema: Schema;
  values: readonly Wish[];
  onValue: (values: Wish[]) => void;
}

/** Things that are alike, each with a line of its own fields. */
function List({field, schema, values, onValue}: ListProps) {
  const {label} = labelOf(field);
  const one = label.toLowerCase();
  return (
    <fieldset class="schema-list">
      <legend>{label} <span class="dim">{field.says}</span></legend>
      {values.map((wish, index) => (
        <div key={index} class="row ends">
          <SchemaForm schema={schema} wish={wish} prefix={`${field.name}-${index + 1}-`}
            onWish={(said) => onValue(values.map((each, place) => (place === index ? said : each)))} />
          {index === values.length - 1 && <Button kind="quiet" label={`Take ${one} ${index + 1} away`} onClick={() => onValue(values.slice(0, -1))}>Take away</Button>}
        </div>
      ))}
      <Button onClick={() => onValue([...values, {}])}>Add a {one}</Button>
    </fieldset>
  );
}

interface MoreProps extends SchemaFormProps {
  /** What the options are of. */
  of: string;
}

/** The options that are seldom said, behind a line that tells how many are. */
export function More({of, schema, wish, onWish, without}: MoreProps) {
  const count = Object.keys(wish).length;
  return (
    <details class="more">
      <summary>Options of {of}{count > 0 && `: ${count} said`}</summary>
      <SchemaForm schema={schema} wish={wish} onWish={onWish} without={without} />
    </details>
  );
}
