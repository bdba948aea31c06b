// SPDX-License-Identifier: Apache-2.0
import type {ComponentChildren} from 'preact';

interface FieldProps {
  label: string;
  value: string;
  onInput: (value: string) => void;
  onEnter?: () => void;
  /** Another value stands, and the hands are elsewhere. */
  onLeave?: () => void;
  unit?: string;
  hint?: ComponentChildren;
  placeholder?: string;
  type?: 'text' | 'number' | 'search' | 'password' | 'date';
  isDisabled?: boolean;
  /** It cannot be used; the hint says why. */
  isWrong?: boolean;
  /** Proposals. */
  list?: readonly string[];
  id?: string;
}

/** A line to type in, with its name above and what is to be known of it below. */
export function Field({label, value, onInput, onEnter, onLeave, unit, hint, placeholder, type = 'text', isDisabled, isWrong, list, id}: FieldProps) {
  const name = id ?? `field-${label.toLowerCase().replace(/[^a-z]+/g, '-')}`;
  const enter = (event: KeyboardEvent) => {
    if (event.key !== 'Enter' || !onEnter) return;
    event.preventDefault();
    onEnter();
  };
  return (
    <div class="field">
      <label for={name}>{label}</label>
      <div class="row">
        <input id={name} type={type} value={value} placeholder={placeholder} disabled={isDisabled} autocomplete="off"
          spellcheck={false} list={list && `${name}-list`} aria-describedby={hint ? `${name}-hint` : undefined}
          aria-invalid={isWrong || undefined}
          step={type === 'number' ? 'any' : undefined}
          onInput={(event) => onInput(event.currentTarget.value)} onChange={onLeave} onKeyDown={enter} />
        {unit && <span class="unit">{unit}</span>}
      </div>
      {list && <datalist id={`${name}-list`}>{list.map((word) => <option key={word} value={word} />)}</datalist>}
      {hint && <div class="hint" id={`${name}-hint`}>{hint}</div>}
    </div>
  );
}
