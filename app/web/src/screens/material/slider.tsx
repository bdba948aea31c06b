// SPDX-License-Identifier: Apache-2.0

interface SliderProps {
  label: string;
  value: number;
  ends: readonly [number, number];
  /** The value in words, where its number alone says too little. */
  says?: string;
  isAssumed?: boolean;
  onChange: (value: number) => void;
}

export function Slider({label, value, ends: [least, most], says = String(Number(value.toFixed(2))), isAssumed, onChange}: SliderProps) {
  return (
    <label class={isAssumed ? 'slider assumed' : 'slider'}>
      <span>{label}</span>
      <input type="range" aria-label={label} min={least} max={most} step="any" value={value} onInput={(event) => onChange(event.currentTarget.valueAsNumber)} />
      <span class="numbers">{says}</span>
    </label>
  );
}
