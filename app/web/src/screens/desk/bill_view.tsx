// SPDX-License-Identifier: Apache-2.0
// What a scan takes and what for, before it begins.
import {costOf, gainOf, totalOf, type BillLine} from './bill';

const names: Record<BillLine['what'], string> = {
  lit: 'Lit', dark: 'Dark', repeat: 'Repeat', bracket: 'Bracket', polariser: 'Polariser', below: 'From below',
};

export function BillView({bill}: {bill: readonly BillLine[]}) {
  return (
    <section class="bill" aria-label="What the scan takes">
      <p class="line"><strong>Scan</strong> <span class="numbers">{totalOf(bill)}</span></p>
      <ul>
        {bill.map((line) => {
          const gain = gainOf(line);
          return (
            <li key={line.what}>
              <p class="line">{names[line.what]} <span class="numbers">{costOf(line)}</span></p>
              <p class="dim">{line.for}{gain && <> <span class="numbers">{gain}.</span></>}</p>
            </li>
          );
        })}
      </ul>
    </section>
  );
}
