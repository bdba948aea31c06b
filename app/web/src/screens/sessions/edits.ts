// SPDX-License-Identifier: Apache-2.0
// Changes of what is said of cloths. Each is a step on the daemon that can be undone, also after it was restarted.
import {signal} from '@preact/signals';
import {answer, api, asApiError, type ApiError, type Schemas} from '../../api/client';
import {forgetCloths, hearOfCloths} from '../../state/cloths';
import type {MetadataChange} from './metadata';

export interface Word {
  says: string;
  error: ApiError | null;
}

/** What was done last, for the line that says it. */
export const lastWord = signal<Word>({says: '', error: null});

export async function change(name: string, body: MetadataChange): Promise<Schemas['Change']> {
  const params = {path: {name}};
  const done = await answer(api.PATCH('/api/v1/sessions/{name}/metadata', {params, body}));
  lastWord.value = {says: done.words, error: null};
  if (body.fabric !== undefined) hearOfCloths([{name, fabric: body.fabric ?? ''}]);
  return done;
}

async function step(path: '/api/v1/undo' | '/api/v1/redo', saying: string): Promise<void> {
  try {
    const done = await answer(api.POST(path, {body: {}}));
    forgetCloths();
    lastWord.value = {says: `${saying}: ${done.words}`, error: null};
  } catch (error) {
    lastWord.value = {says: '', error: asApiError(error)};
  }
}

export const undo = () => step('/api/v1/undo', 'Undone');
export const redo = () => step('/api/v1/redo', 'Done again');
