// SPDX-License-Identifier: Apache-2.0
// What can be asked for, as the daemon says it: kinds of jobs with what they may be told, and walks of a calibration.
import {signal} from '@preact/signals';
import {answer, api, type Schemas} from '../api/client';
import {type Schema, schemaOf, wordsOf} from '../ui/request_schema';

export type Forms = Schemas['Forms'];

export const forms = signal<Forms>({jobs: [], walks: {all: [], refresh: []}, things: {board: {}, sheet: {}, chart: {}}});

/** Once, before anything is shown: they are the same for as long as the daemon runs. */
export async function askForms(): Promise<void> {
  forms.value = await answer(api.GET('/api/v1/forms'));
}

/** What a job of this kind may be told. */
export function formOf(kind: string): Schema {
  return schemaOf(forms.value.jobs.find((form) => form.kind === kind)?.schema);
}

export function titleOf(kind: string): string {
  return forms.value.jobs.find((form) => form.kind === kind)?.title ?? kind;
}

export type Quality = NonNullable<Schemas['SolveJob']['quality']>;

/** Levels of the solver, the quickest first. */
export function levels(): Quality[] {
  return wordsOf(formOf('solve'), 'quality') as Quality[];
}
