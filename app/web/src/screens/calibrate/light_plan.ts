// SPDX-License-Identifier: Apache-2.0
// What one more LED, one moved or polarisers would tell of a cloth, as a job `rig_plan` found out.
import {fieldsOf, listIn, numberIn, textIn, textsIn} from '../../ui/fields';

export interface LightPlan {
  rig: string;
  leds: number;
  cloth: string;
  /** What the strength of the cloth's lobe is called; empty: a matt cloth has none. */
  strength: 'f0' | 'sheen' | '';
  verdict: string;
  notes: string[];
  rows: LightRow[];
}

/** One set of lights. Null is what its photographs do not tell. */
export interface LightRow {
  name: string;
  what: string;
  normal_deg: number | null;
  alpha: number | null;
  strength: number | null;
  isObservable: boolean;
  shots: number;
  seconds: number;
  won_deg: number | null;
}

export function lightPlanOf(result: unknown): LightPlan | null {
  const rows = listIn(result, 'rows');
  if (rows.length === 0) return null;
  const cloth = fieldsOf(result)['cloth'];
  const strength = 'sheen' in fieldsOf(cloth) ? 'sheen' : 'f0' in fieldsOf(cloth) ? 'f0' : '';
  return {
    rig: textIn(result, 'rig'),
    leds: numberIn(result, 'leds') ?? 0,
    cloth: textIn(cloth, 'name'),
    strength,
    verdict: textIn(result, 'verdict'),
    notes: textsIn(result, 'notes'),
    rows: rows.map((row) => rowOf(row, strength)),
  };
}

function rowOf(row: unknown, strength: string): LightRow {
  const sigma = fieldsOf(row)['sigma'];
  return {
    name: textIn(row, 'name'),
    what: textIn(row, 'what'),
    normal_deg: numberIn(sigma, 'normal_deg'),
    alpha: numberIn(sigma, 'alpha'),
    strength: numberIn(sigma, strength),
    isObservable: fieldsOf(row)['observable'] === true,
    shots: numberIn(row, 'extra_shots') ?? 0,
    seconds: numberIn(row, 'extra_seconds') ?? 0,
    won_deg: numberIn(row, 'degrees_won'),
  };
}

/** "+0.013", "-0.080", "0.000"; "-" for what nobody knows. */
export function signed(value: number | null, decimals = 0): string {
  if (value === null) return '-';
  const text = value.toFixed(decimals);
  return Number(text) > 0 ? `+${text}` : text.replace(/^-(?=[0.]*$)/, '');
}
