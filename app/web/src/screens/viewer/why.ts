// SPDX-License-Identifier: Apache-2.0
// What the daemon's report says of a solve, stage by stage: which ran, which did not, and what speaks for it.
import type {Schemas} from '../../api/client';
import {digits} from '../../ui/say';

export type SolveReport = Schemas['SolveReport'];

export interface SolveStage {
  name: string;
  ran: boolean;
  says: string;
}

/** Of light in the cloth; without a distance it was left as it is. */
interface Spread {
  said: string;
  share: number;
  share_sigma?: number;
  mean_mm?: number;
  mean_px?: number;
  mean_sigma_mm?: number;
}

interface Conditions {
  hot_photosites?: number;
  veil?: number;
  brackets?: number;
  drift?: {led: number; factor: number; from: string}[];
  cloth_gains?: {leds: {led: number; factor: number}[]; left_out_gain: number; left_out_sigma: number};
  cloth_spread?: Spread;
  left_out?: {led: number; why: string}[];
}

interface ShotPlace {
  led: number;
  corrected: boolean;
  verdict: string;
  dx_px: number;
  dy_px: number;
}

interface Reference {
  stages: string[];
  left_out?: {stage: string; gain: number; sigma: number; patches: number; kept: boolean}[];
  rounds: {turned_deg: number; refused?: boolean}[];
}

interface SolvedBy {
  robust_share?: number;
  rejected_readings?: number;
}

export interface Gate {
  name: string;
  value: number;
  limit: number;
  unit: string;
  verdict: 'over' | 'under';
}

export interface LeftOutCheck {
  median: number;
  noise_median?: number;
  readings: number;
  lights: {light: number; median: number; noise_median?: number}[];
}

export interface Warning {
  name: string;
  text: string;
  remedy: string;
}

/** The report's parts as docs/formats.md has them; null where the solve has none. */
export function partsOf(report: SolveReport) {
  return {
    conditions: (report.conditions ?? {}) as Conditions,
    registration: (report.registration ?? []) as unknown as ShotPlace[],
    sharpening: report.sharpening as unknown as {share: number} | null | undefined,
    lateral: report.lateral_color as unknown as {corner_px: {red?: number; blue?: number} | number[]} | null | undefined,
    reference: report.reference as unknown as Reference | null,
    solvedBy: (report.solved_by ?? {}) as SolvedBy,
    gates: (report.gates ?? []) as unknown as Gate[],
    check: (report.check ?? null) as unknown as LeftOutCheck | null,
    warnings: report.warnings as unknown as Warning[],
    seconds: report.seconds as Record<string, number>,
  };
}

const percent = (share: number) => `${digits(100 * share)} %`;

function gain(each: {gain: number; sigma: number}): string {
  return `left-out light is predicted better by ${percent(each.gain)} ± ${percent(each.sigma)} of the brightness`;
}

function foundOf(hot: number): string {
  return hot === 0 ? 'None was found.' : `${hot} were given their neighbours' counts.`;
}

function spreadInWords({said, share, share_sigma, mean_mm, mean_px, mean_sigma_mm}: Spread): string {
  const sigma = (value: number | undefined, inWords: (value: number) => string) => (value === undefined ? '' : ` ± ${inWords(value)}`);
  const amount = percent(share) + sigma(share_sigma, percent);
  if (said === 'not_observable') return `The blade shows none: ${amount}.`;
  const by = said === 'given' ? '' : `, as the ${said === 'told' ? 'cloth' : 'blade'} tells`;
  const distance = mean_mm === undefined ? `${digits(mean_px ?? 0)} pixels` : `${digits(mean_mm)}${sigma(mean_sigma_mm, digits)} mm`;
  return `${amount} left ${distance} away${by}, and was taken off.`;
}

function ofConditions(conditions: Conditions): SolveStage[] {
  const {hot_photosites: hot, veil, brackets = 0, drift = [], cloth_gains: told, left_out: leftOut = [], cloth_spread: spread} = conditions;
  const most = Math.max(0, ...drift.map(({factor}) => Math.abs(factor - 1)));
  return [
    {name: 'Bad photosites', ran: hot !== undefined, says: hot === undefined ? 'Not looked for.' : foundOf(hot)},
    {name: 'Stray light of the lens', ran: veil !== undefined, says: veil === undefined ? 'Not known of this rig.' : `${percent(veil)} was taken off.`},
    {
      name: 'Light that spreads in the cloth',
      ran: spread !== undefined && spread.said !== 'not_observable',
      says: spread ? spreadInWords(spread) : 'None was found.',
    },
    {name: 'Brackets', ran: brackets > 0, says: brackets > 0 ? `${brackets} shots of other exposures were joined.` : 'The session has none.'},
    {
      name: 'Drift of LEDs',
      ran: drift.length > 0,
      says: drift.length > 0 ? `Measured by ${drift[0]?.from === 'patches' ? 'white patches' : 'repeated shots'}, ${percent(most)} at most.` : 'Not measured in this session.',
    },
    {
      name: 'LED fluxes told by the cloth',
      ran: told !== undefined,
      says: told ? `With them ${gain({gain: told.left_out_gain, sigma: told.left_out_sigma})}.` : 'Not taken.',
    },
    {
      name: 'Lights that tell nothing',
      ran: true,
      says: leftOut.length > 0 ? `Left out: ${leftOut.map(({led, why}) => `LED ${led}, ${why}`).join('; ')}.` : 'All were used.',
    },
  ];
}

function ofRegistration(shots: readonly ShotPlace[]): SolveStage {
  const moved = shots.filter(({corrected}) => corrected);
  const flagged = shots.filter(({verdict}) => verdict === 'flagged');
  const list = (these: readonly ShotPlace[]) => these.map(({led, dx_px, dy_px}) => `LED ${led} by ${digits(Math.hypot(dx_px, dy_px))} px`).join(', ');
  if (shots.length === 0) return {name: 'Registration', ran: false, says: 'Not done at this level.'};
  if (moved.length > 0) return {name: 'Registration', ran: true, says: `The cloth moved and these were left out: ${list(moved)}.`};
  if (flagged.length > 0) return {name: 'Registration', ran: true, says: `Something moved: ${list(flagged)}.`};
  return {name: 'Registration', ran: true, says: 'No shot moved.'};
}

const lightStages: readonly {stage: string; name: string}[] = [
  {stage: 'shadows', name: 'Cast shadows'},
  {stage: 'interreflection', name: 'Light between yarns'},
];

function ofReference(reference: Reference | null): SolveStage[] {
  return lightStages.map(({stage, name}) => {
    if (!reference) return {name, ran: false, says: 'Taken out at the level reference alone.'};
    const said = reference.left_out?.find((each) => each.stage === stage);
    const ran = reference.stages.includes(stage);
    const by = said ? `With it ${gain(said)}, over ${said.patches} patches.` : 'Left-out light was not asked.';
    return {name, ran, says: `${ran ? 'Taken out.' : 'Left in.'} ${by}`};
  });
}

function robustInWords(share: number | undefined): string {
  if (share === undefined) return 'Not at this level.';
  return share > 0 ? `On ${percent(share)} of the frame, where it predicted left-out light better.` : 'Nowhere did it predict left-out light better.';
}

function ofRobust({robust_share: share, rejected_readings: rejected = 0}: SolvedBy): SolveStage[] {
  return [
    {
      name: 'Robust against highlights',
      ran: (share ?? 0) > 0,
      says: robustInWords(share),
    },
    {name: 'Misfits rejected', ran: rejected > 0, says: rejected > 0 ? `${rejected} readings.` : 'None.'},
  ];
}

function ofGloss(gloss: SolveReport['gloss']): SolveStage {
  return {name: 'Gloss', ran: gloss?.used ?? false, says: gloss ? `${gloss.says}.` : 'Not at this level.'};
}

/** Every stage, in the order in which a solve comes by them. */
export function stagesOf(report: SolveReport): SolveStage[] {
  const {conditions, registration, sharpening, lateral, reference, solvedBy} = partsOf(report);
  return [
    ...ofConditions(conditions),
    ofRegistration(registration),
    {name: 'Lateral colour of the lens', ran: lateral != null, says: lateral ? 'Red and blue were laid on green.' : 'Not measured for this lens.'},
    {
      name: 'Sharpening',
      ran: sharpening != null,
      says: sharpening ? `${percent(sharpening.share)} of the lens's blur was undone; noise allowed no more.` : 'The lens\'s blur is not known, or was left.',
    },
    ...ofRobust(solvedBy),
    ...ofReference(reference),
    ofGloss(report.gloss),
  ];
}
