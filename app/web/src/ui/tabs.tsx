// SPDX-License-Identifier: Apache-2.0
import './tabs.css';
import type {ComponentChildren} from 'preact';
import {useRef} from 'preact/hooks';

interface TabsProps<T extends string> {
  label: string;
  value: T;
  options: readonly {value: T; says: string}[];
  onChange: (value: T) => void;
  /** What belongs to the chosen one. */
  children: ComponentChildren;
}

/** A few panels in one place. Arrows go from one tab to the next. */
export function Tabs<T extends string>({label, value, options, onChange, children}: TabsProps<T>) {
  const list = useRef<HTMLDivElement>(null);
  const turn = (event: KeyboardEvent) => {
    const step = event.key === 'ArrowRight' ? 1 : event.key === 'ArrowLeft' ? -1 : 0;
    if (step === 0) return;
    event.preventDefault();
    const index = (options.findIndex((option) => option.value === value) + step + options.length) % options.length;
    const next = options[index];
    if (next) onChange(next.value);
    (list.current?.children[index] as HTMLElement | undefined)?.focus();
  };
  return (
    <div class="tabs">
      <div ref={list} role="tablist" aria-label={label} onKeyDown={turn}>
        {options.map((option) => (
          <button key={option.value} type="button" role="tab" id={`tab-${option.value}`} aria-selected={option.value === value}
            aria-controls="tab-panel" tabIndex={option.value === value ? 0 : -1} onClick={() => onChange(option.value)}>
            {option.says}
          </button>
        ))}
      </div>
      <div role="tabpanel" id="tab-panel" aria-labelledby={`tab-${value}`}>{children}</div>
    </div>
  );
}
