// SPDX-License-Identifier: Apache-2.0
// One step of a recipe: what it does, and its keys as the daemon describes them.
import {useState} from 'preact/hooks';
import {Button} from '../../ui/button';
import {Choice} from '../../ui/choice';
import type {Spot, Step, StepKey, StepKind} from './recipe';

interface StepFormProps {
  /** From 0. */
  index: number;
  step: Step;
  kind: StepKind | undefined;
  isFirst: boolean;
  isLast: boolean;
  /** Keys of the rectangle that is drawn; null: there is none, or this step has no place. */
  fromBox: Record<string, unknown> | null;
  onKeys: (keys: Record<string, unknown>) => void;
  onMove: (by: 1 | -1) => void;
  onRemove: () => void;
}

export function StepForm({index, step, kind, isFirst, isLast, fromBox, onKeys, onMove, onRemove}: StepFormProps) {
  const name = `${index + 1} ${step.do}`;
  return (
    <li class="step">
      <div class="row">
        <strong>{name}</strong>
        <Button kind="quiet" label={`${name} earlier`} isDisabled={isFirst} onClick={() => onMove(-1)}>↑</Button>
        <Button kind="quiet" label={`${name} later`} isDisabled={isLast} onClick={() => onMove(1)}>↓</Button>
        <Button kind="quiet" label={`Remove ${name}`} onClick={onRemove}>Remove</Button>
      </div>
      <p class="dim">{kind?.says}</p>
      {kind?.keys.map((key) => (
        <KeyField key={key.name} label={`${name} ${key.name}`} of={key} value={step[key.name] ?? key.default} onChange={(value) => onKeys({[key.name]: value})} />
      ))}
      {fromBox && <Button onClick={() => onKeys(fromBox)}>{step.do === 'crop' ? 'To the rectangle' : 'Add the rectangle'}</Button>}
    </li>
  );
}

interface KeyFieldProps {
  label: string;
  of: StepKey;
  value: unknown;
  onChange: (value: unknown) => void;
}

function KeyField({label, of, value, onChange}: KeyFieldProps) {
  const {name, says} = of;
  switch (of.holds) {
    case 'flag':
      return (
        <label class="key">
          <input type="checkbox" aria-label={label} checked={value === true} onChange={(event) => onChange(event.currentTarget.checked)} />
          {name} <span class="dim">{says}</span>
        </label>
      );
    case 'word':
      return (
        <>
          <Choice label={label} value={String(value)} options={of.words.map((word) => ({value: word, says: word}))} onChange={onChange} />
          <p class="dim">{says}</p>
        </>
      );
    case 'spots':
      return <Typed label={label} of={of} text={textOfSpots(value)} onText={(text) => onChange(spotsIn(text))} />;
    case 'numbers':
      return <Typed label={label} of={of} text={Array.isArray(value) ? value.join(' ') : ''} onText={(text) => onChange(numbersIn(text))} />;
    case 'maybe':
      return <Typed label={label} of={of} text={typeof value === 'number' ? String(value) : ''} onText={(text) => onChange(maybeIn(text))} />;
    default:
      return <Typed label={label} of={of} text={String(value)} onText={(text) => onChange(Number(text.replace(',', '.')))} />;
  }
}

/** Text that holds once it is typed to its end, so that a number is one change. */
function Typed({label, of: {name, says}, text, onText}: {label: string; of: StepKey; text: string; onText: (text: string) => void}) {
  const [typed, setTyped] = useState<string | null>(null);
  const finish = () => {
    if (typed !== null && typed !== text) onText(typed);
    setTyped(null);
  };
  return (
    <label class="key">
      {name}
      <input aria-label={label} value={typed ?? text} spellcheck={false} autocomplete="off" onInput={(event) => setTyped(event.currentTarget.value)}
        onBlur={finish} onKeyDown={(event) => event.key === 'Enter' && finish()} />
      <span class="dim">{says}</span>
    </label>
  );
}

export function numbersIn(text: string): number[] {
  return text.split(/[\s;]+/).filter((word) => word !== '').map((word) => Number(word.replace(',', '.')));
}

/** Null where nothing is typed. */
export function maybeIn(text: string): number | null {
  return numbersIn(text)[0] ?? null;
}

/** "12 30 1.5; 40 8 2": places in millimetres, each with its radius. */
export function textOfSpots(value: unknown): string {
  const spots = Array.isArray(value) ? (value as Spot[]) : [];
  return spots.map(({x_mm, y_mm, radius_mm}) => `${x_mm} ${y_mm} ${radius_mm}`).join('; ');
}

export function spotsIn(text: string): Spot[] {
  return text.split(';').map(numbersIn).filter((numbers) => numbers.length > 0)
    .map(([x_mm = NaN, y_mm = NaN, radius_mm = NaN]) => ({x_mm, y_mm, radius_mm}));
}
