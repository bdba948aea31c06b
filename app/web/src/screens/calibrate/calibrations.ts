// SPDX-License-Identifier: Apache-2.0
// What the daemon knows of the rig's calibration. Nothing of a walk is kept here: a reload or another tablet goes on.
import {batch, computed, signal} from '@preact/signals';
import {useEffect} from 'preact/hooks';
import {answer, api, asApiError, type ApiError, type Schemas} from '../../api/client';
import {onEvent} from '../../api/events';
import {forms} from '../../state/forms';
import {withDevicesFree} from '../desk/devices';
import type {Fields} from '../../ui/fields';
import {jobs, useJobs} from '../jobs/jobs';
import {hasEnded} from '../jobs/queue';
import {historyOf, noHistory, type CalibrationHistory} from './history';
import type {PhotographSet} from './photograph_set';
import type {Known, Listed, Part} from './walk';

export const calibrations = signal<readonly Listed[]>([]);
const series = signal<readonly string[]>([]);
export const history = signal<CalibrationHistory>(noHistory);
/** The set that is worked on; null: none, or not known yet. */
export const work = signal<PhotographSet | null>(null);
/** What the doctor says of the calibration. */
export const findings = signal<Schemas['Doctor']['findings']>([]);
export const complaint = signal<ApiError | null>(null);
/** False until the first answers. */
export const isKnown = signal(false);

export const known = computed<Known>(() => ({
  calibrations: calibrations.value,
  checks: history.value.checks,
  jobs: jobs.value,
  series: series.value,
  walks: forms.value.walks,
}));

export async function askCalibrations(): Promise<void> {
  try {
    const {calibrations: listed, complete_series} = await answer(api.GET('/api/v1/calibrations'));
    const isDated = listed.some((each) => Boolean(each.measured));
    const measured = isDated ? historyOf(await answer(api.GET('/api/v1/calibrations/history'))) : noHistory;
    batch(() => {
      calibrations.value = listed;
      series.value = complete_series;
      history.value = measured;
      complaint.value = null;
    });
  } catch (error) {
    complaint.value = asApiError(error);
  }
  isKnown.value = true;
}

async function askDoctor(): Promise<void> {
  const doctor = await answer(api.GET('/api/v1/doctor')).catch(() => null);
  findings.value = doctor?.findings.filter((finding) => finding.part === 'calibration') ?? [];
}

async function askWork(): Promise<void> {
  work.value = await answer(api.GET('/api/v1/calibrations/work')).catch(() => null);
}

/** Keeps all of it up to date for as long as a component is shown. */
export function useCalibrations(): void {
  useJobs();
  useEffect(() => {
    const askAll = () => {
      void askCalibrations();
      void askDoctor();
      void askWork();
    };
    askAll();
    const ends = [
      onEvent('calibration', (set) => void (askWork(), set?.done && askCalibrations())),
      onEvent('gap', askAll),
      onEvent('job', (job) => void (isOfCalibration(job.kind) && hasEnded(job) && askCalibrations())),
    ];
    return () => ends.forEach((end) => end());
  }, []);
}

function isOfCalibration(kind: string): boolean {
  return kind === 'check' || kind.startsWith('calibrate_');
}

export interface SetWish {
  part: Part;
  name: string;
  from: string | null;
  /** What lies there, in the fields of its form or the text of its file; null: as the rig knows it. */
  thing: Fields | string | null;
}

/** Begins a set or goes on with it. */
export async function workOn({part, name, from, thing}: SetWish): Promise<void> {
  const described = thing === null ? {} : typeof thing === 'string' ? {description: thing} : {thing};
  const body = {part, name, ...(from === null ? {} : {from}), ...described};
  work.value = await answer(api.POST('/api/v1/calibrations/work', {body}));
}

export async function photograph(): Promise<void> {
  const headers = {'Content-Type': 'application/json'};
  work.value = await withDevicesFree(() => answer(api.POST('/api/v1/calibrations/work/photograph', {headers})));
}

export async function leaveOut(name: string, out: boolean): Promise<void> {
  work.value = await answer(api.POST('/api/v1/calibrations/work/leave-out', {body: {name, out}}));
}

/** What accepting a calibration changes; with `isMeant` it becomes the rig's. */
export async function accept(calibration: string, isMeant: boolean) {
  return await answer(api.POST('/api/v1/calibrations/accept', {body: {calibration, dry_run: !isMeant}}));
}
