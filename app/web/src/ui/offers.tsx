// SPDX-License-Identifier: Apache-2.0
// What may be bought, each with what it costs and gives: a click, or Enter, takes it.
import type {ComponentChildren} from 'preact';

export interface Offer {
  says: string;
  figures: string;
  isBest: boolean;
  isTaken?: boolean;
  take?: () => void;
}

export function Offers({label, offers, children}: {label: string; offers: readonly Offer[]; children?: ComponentChildren}) {
  if (offers.length === 0) return null;
  return (
    <ul class="offers" aria-label={label}>
      {offers.map(({says, figures, isBest, isTaken, take}) => {
        const Line = take ? 'button' : 'p';
        return (
          <li key={says}>
            <Line class={take ? 'line button quiet' : 'line'} {...take && {type: 'button', 'aria-pressed': isTaken, onClick: take}}>
              {isBest ? <strong>{says}: the one to buy</strong> : <span>{says}</span>}
              <span class="numbers">{figures}</span>
            </Line>
          </li>
        );
      })}
      {children}
    </ul>
  );
}
