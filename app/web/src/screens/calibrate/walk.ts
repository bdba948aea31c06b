// SPDX-License-Identifier: Apache-2.0
// The way from photographs to a calibration that the rig scans with. Where a walk stands is what lies beside the rig
// file: sets/NAME-..., calibrations/NAME-...; so any browser goes on with it.
import type {Schemas} from '../../api/client';
import {fieldsOf, listIn, numberIn, textIn} from '../../ui/fields';
import type {Offer} from '../../ui/offers';
import {counted, degrees, digits} from '../../ui/say';
import {durationOf} from '../../ui/words';
import type {Job} from '../jobs/queue';
import type {PhotographSet} from './photograph_set';

export type Listed = Schemas['ListedCalibration'];
export type JobRequest = Schemas['JobRequest'];
export type WalkKind = keyof Walks;
/** The stages of each walk, as the daemon has them. */
export type Walks = Schemas['Forms']['walks'];
export type WalkStage = Schemas['WalkStage'];
export type Part = WalkStage['part'];

export interface Walk {
  kind: WalkKind;
  name: string;
}

/** What lies beside the rig file, as the daemon lists it. */
export interface Known {
  calibrations: readonly Listed[];
  checks: readonly CheckResult[];
  jobs: readonly Job[];
  /** Names of the sets that are photographed as a series, and are whole. */
  series: readonly string[];
  walks: Walks;
}

export interface CheckResult {
  folder: string;
  date: string;
  calibration: string;
  passed: boolean;
  found: string;
}

export type Standing = 'open' | 'working' | 'failed' | 'done' | 'found';

export function stagesOf(walk: Walk, {walks}: Known): readonly WalkStage[] {
  return walks[walk.kind];
}

export function setOf(walk: Walk, stage: WalkStage): string {
  return `${walk.name}-${stage.part}`;
}

export function folderOf(walk: Walk, stage: WalkStage): string {
  return `calibrations/${walk.name}-${stage.result}`;
}

/** The newest job that is to write a stage's folder; null: there was none. */
export function jobOf(walk: Walk, stage: WalkStage, known: Known): Job | null {
  const folder = folderOf(walk, stage);
  return known.jobs.find((job) => job.kind === stage.job && textIn(job.wants, 'output') === folder) ?? null;
}

export function standingOf(walk: Walk, stage: WalkStage, known: Known): Standing {
  if (stage.is_aside) return known.series.includes(setOf(walk, stage)) ? 'done' : 'open';
  const folder = folderOf(walk, stage);
  const check = known.checks.find((each) => each.folder === folder);
  if (check) return check.passed ? 'done' : 'found';
  if (known.calibrations.some((each) => each.folder === folder)) return 'done';
  const job = jobOf(walk, stage, known);
  switch (job?.state) {
    case 'queued':
    case 'running':
      return 'working';
    case 'done':
      return job.exit_code ? 'found' : 'done';
    case 'failed':
      return 'failed';
    default:
      return 'open';
  }
}

/** Whether the photographs of this part told enough: a result is there, good or not. */
export function hasResult(standing: Standing): boolean {
  return standing === 'done' || standing === 'found';
}

/** The stage that a person is at; null: all of them have a result. */
export function currentStage(walk: Walk, known: Known): WalkStage | null {
  const all = stagesOf(walk, known);
  const last = all.filter((stage) => hasResult(standingOf(walk, stage, known))).at(-1);
  const after = all.slice(last === undefined ? 0 : all.indexOf(last) + 1);
  return after.find((stage) => !stage.is_aside) ?? null;
}

/** That nothing moved: a knock did no harm. */
export function isUnharmed(walk: Walk, known: Known): boolean {
  const first = stagesOf(walk, known)[0];
  return walk.kind === 'refresh' && first !== undefined && standingOf(walk, first, known) === 'done';
}

/** The calibration that a stage begins with: the last one of the walk before it, else the rig's. */
export function fromOf(walk: Walk, stage: WalkStage, known: Known): string | null {
  const all = stagesOf(walk, known);
  const before = all.slice(0, all.indexOf(stage));
  const made = before.map((each) => folderOf(walk, each)).filter((folder) => isListed(folder, known));
  return made.at(-1) ?? known.calibrations.find((each) => each.is_rigs)?.folder ?? null;
}

/** The calibration that the walk has made; null: none yet. */
export function madeBy(walk: Walk, known: Known): string | null {
  const made = stagesOf(walk, known).map((stage) => folderOf(walk, stage)).filter((folder) => isListed(folder, known));
  return made.at(-1) ?? null;
}

function isListed(folder: string, known: Known): boolean {
  return known.calibrations.some((each) => each.folder === folder);
}

/** Each kind of job takes those of them that the stages of its part have. */
function inputsOf(walk: Walk, stage: WalkStage, known: Known) {
  const set = `sets/${setOf(walk, stage)}`;
  const from = fromOf(walk, stage, known);
  return {
    kind: stage.job,
    ...(stage.part === 'moved' ? {moved: set} : {input: set}),
    ...(stage.result === 'response' && known.series.includes(`${walk.name}-trap`) ? {trap: `sets/${walk.name}-trap`} : {}),
    ...(from === null ? {} : {from}),
  };
}

export function requestOf(walk: Walk, stage: WalkStage, known: Known): JobRequest {
  return {...inputsOf(walk, stage, known), output: folderOf(walk, stage)} as JobRequest;
}

/** Poses from which each part is known at all. */
const fewest: Partial<Record<Part, number>> = {sheet: 1, board: 3};

/**
 * What the sheets by now would give of the lights, and what more sheets or boards would: jobs that write nothing, while
 * more are wanted. The same photographs are the same jobs, whoever looks.
 */
export function trialsOf(walk: Walk, stage: WalkStage, set: PhotographSet, known: Known): JobRequest[] {
  const used = set.photographs.filter((photograph) => photograph.used).map(({name}) => name);
  if (set.next === null || used.length < (fewest[stage.part] ?? Infinity)) return [];
  const kinds = [...(stage.part === 'sheet' ? [stage.job] : []), `${stage.job}_price`];
  return kinds.map((kind) => ({...inputsOf(walk, stage, known), kind, request_id: [setOf(walk, stage), kind, ...used].join('.')}) as JobRequest);
}

/** Walks that were begun, the newest first: results beside the rig file carry their names. */
export function walksIn(known: Known): Walk[] {
  const walks = new Map<string, Walk>();
  const dated = [
    ...known.calibrations.map((each) => ({folder: each.folder, date: each.measured ?? ''})),
    ...known.checks,
  ].sort((a, b) => b.date.localeCompare(a.date));
  for (const {folder} of dated) {
    const walk = walkOfFolder(folder, known.walks);
    if (walk && !walks.has(walk.name)) walks.set(walk.name, walk);
  }
  return [...walks.values()];
}

function walkOfFolder(folder: string, walks: Walks): Walk | null {
  const [, name, result] = /^calibrations\/(.+)-([a-z]+)$/.exec(folder) ?? [];
  if (name === undefined || result === undefined) return null;
  const kind = (Object.keys(walks) as WalkKind[]).find((each) =>
    walks[each].some((stage) => stage.result === result && stage.part !== 'check'),
  );
  return kind ? {kind, name} : null;
}

/** Where the set that is worked on belongs, by its name. */
export function walkOfSet(set: {name: string; part: string}): Walk | null {
  const ending = `-${set.part}`;
  if (!set.name.endsWith(ending)) return null;
  const kind = set.part === 'moved' ? 'refresh' : 'all';
  return {kind, name: set.name.slice(0, -ending.length)};
}

/** A name that no walk has: the day, and a number from the second one on. */
export function freeName(day: string, walks: readonly Walk[]): string {
  const isFree = (name: string) => walks.every((walk) => walk.name !== name);
  for (let number = 1; ; ++number) {
    const name = number === 1 ? day : `${day}-${number}`;
    if (isFree(name)) return name;
  }
}

/** What a step of weft calibrate says of its result: what is wrong or weak, each with a remedy. */
export interface WalkFinding {
  text: string;
  remedy: string;
}

/** What it said beside its findings, which it says on their own, too. */
export function notesBeside(notes: readonly string[], findings: readonly WalkFinding[]): string[] {
  return notes.filter((note) => findings.every(({text}) => !note.startsWith(text)));
}

export function findingsIn(verdicts: readonly unknown[]): WalkFinding[] {
  return verdicts.map((each) => ({text: textIn(each, 'text'), remedy: textIn(each, 'remedy')}));
}

/** What a price says of more poses: "6 poses, 2 more", "0.07 mm, 0.03°, 40 s". */
export function posesIn(result: unknown): Offer[] {
  return listIn(result, 'rows').map((row) => {
    const [poses, more, rig_s, deg, place_mm, position_mm] = ['poses', 'more', 'rig_s', 'predicted_deg', 'place_mm', 'position_mm'].map((key) => numberIn(row, key));
    return {
      says: counted(poses ?? 0, 'pose') + (more ? `, ${more} more` : ''),
      figures: `${digits(place_mm ?? position_mm ?? 0)} mm, ${degrees(deg ?? 0)}` + (more ? `, ${durationOf(rig_s ?? 0)}` : ''),
      isBest: fieldsOf(row)['chosen'] === true,
    };
  });
}
