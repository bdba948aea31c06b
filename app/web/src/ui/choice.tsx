// SPDX-License-Identifier: Apache-2.0

interface ChoiceProps<T extends string> {
  label: string;
  value: T;
  options: readonly {value: T; says: string}[];
  onChange: (value: T) => void;
  /** What is to be known of it, for a hand that rests on it. */
  says?: string;
}

/** One of a few. */
export function Choice<T extends string>({label, value, options, onChange, says}: ChoiceProps<T>) {
  const name = `choice-${label.toLowerCase().replace(/[^a-z]+/g, '-')}`;
  return (
    <div class="field">
      <label for={name}>{label}</label>
      <select id={name} title={says} value={value} onChange={(event) => onChange(event.currentTarget.value as T)}>
        {options.map((option) => <option key={option.value} value={option.value}>{option.says}</option>)}
      </select>
    </div>
  );
}
