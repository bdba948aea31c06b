// SPDX-License-Identifier: Apache-2.0
import type {ComponentChildren} from 'preact';

export type Verdict = 'fine' | 'warning' | 'fault' | 'waiting' | 'busy';

const shapes: Record<Verdict, string> = {fine: '●', warning: '▲', fault: '■', waiting: '○', busy: '◐'};

/** A verdict by shape and word, and by colour beside them. */
export function Mark({verdict, children}: {verdict: Verdict; children?: ComponentChildren}) {
  return (
    <span class={`mark ${verdict}`}>
      <span aria-hidden="true">{shapes[verdict]}</span>{'\u00a0'}{children ?? verdict}
    </span>
  );
}
