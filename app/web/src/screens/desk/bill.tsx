// SPDX-License-Identifier: Apache-2.0
// What a scan takes and what for, before it begins: the daemon's bill in words.
import {useState} from 'preact/hooks';
import {answer, api, asApiError, type ApiError, type Schemas} from '../../api/client';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {Offers} from '../../ui/offers';
import {counted, degrees, degreesOn} from '../../ui/say';
import {durationOf} from '../../ui/words';
import {bought} from './cloth';

export type BillLine = Schemas['BillLine'];

function costInWords(shots: number, seconds: number | null): string {
  return counted(shots, 'shot') + (seconds === null ? '' : `, ${durationOf(seconds)}`);
}

export function costOf({shots, seconds}: BillLine): string {
  return costInWords(shots, seconds);
}

/** What the whole scan takes: without a time where that of some shots is not known. */
export function totalOf(bill: readonly BillLine[]): string {
  const shots = bill.reduce((sum, line) => sum + line.shots, 0);
  const seconds = bill.reduce<number | null>((sum, line) => (sum === null || line.seconds === null ? null : sum + line.seconds), 0);
  return costInWords(shots, seconds);
}

/** "0.40° without, 0.0013° with"; null where nobody measured it. */
export function gainOf({without_deg, with_deg}: BillLine): string | null {
  if (without_deg === null || with_deg === null) return null;
  return `${degrees(without_deg)} without, ${degrees(with_deg)} with`;
}

const names: Record<BillLine['what'], string> = {
  lit: 'Lit', dark: 'Dark', repeat: 'Repeat', bracket: 'Bracket', polariser: 'Polariser', below: 'From below', blade: 'Blade',
};

/** What else may be bought, asked for once: the lights, the calibration and the last scan tell it. */
export function OtherShots({request}: {request: Schemas['ScanRequest']}) {
  const [offers, take] = useState<Schemas['ScanPrices'] | ApiError | null>(null);
  if (!offers) {
    return <Button kind="quiet" onClick={() => void answer(api.POST('/api/v1/scan/price', {body: request})).catch(asApiError).then(take)}>Other shots</Button>;
  }
  if (offers instanceof Error) return <Complaint error={offers} />;
  return (
    <Offers label="Other shots" offers={offers.rows.map((row) => ({
      says: row.what,
      figures: (row.predicted_deg === null ? '' : `${degreesOn(row.predicted_deg, row.solved)}, `) + costInWords(row.shots, row.seconds),
      isBest: row.chosen,
      isTaken: bought.value ? bought.value.what === row.what : row.asked,
      take: () => { bought.value = row.asked ? null : row; },
    }))}>
      {offers.notes.map((note) => <li key={note} class="dim">{note}</li>)}
    </Offers>
  );
}

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
