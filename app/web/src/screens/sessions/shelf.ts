// SPDX-License-Identifier: Apache-2.0
// The sessions that the filters leave, as far as they were asked for: a page at a time, the newest first.
import {signal} from '@preact/signals';
import {answer, api, asApiError, type ApiError} from '../../api/client';
import {questionOf, type Filters} from './filters';
import type {Summary} from './metadata';

const pageLength = 200;

export interface Shelf {
  sessions: readonly Summary[];
  /** How many there are on all pages, those not asked for yet too. */
  total: number;
  /** Key of the next page; null: all are here. */
  after: number | null;
  /** The search that found them; 0: none has answered yet. */
  search: number;
}

const empty: Shelf = {sessions: [], total: 0, after: null, search: 0};
export const shelf = signal<Shelf>(empty);
export const complaint = signal<ApiError | null>(null);
export const tags = signal<readonly string[]>([]);

let question: Record<string, string> = {};
/** The number of the search that is shown: an answer to one before it comes too late. */
let search = 0;
let isAsking = false;

async function page(after: number | null) {
  const query = {...question, limit: pageLength, ...(after === null ? {} : {after})};
  return await answer(api.GET('/api/v1/sessions', {params: {query}}));
}

/** What these filters leave, as it is now: the first page, and of the same search as much as was seen before. */
export async function look(filters: Filters): Promise<void> {
  const before = JSON.stringify(question);
  question = questionOf(filters);
  const seen = before === JSON.stringify(question) ? shelf.value.sessions.length : 0;
  const mine = ++search;
  try {
    let {sessions, total, after} = await page(null);
    while (mine === search && after !== null && sessions.length < seen) {
      const next = await page(after);
      sessions = [...sessions, ...next.sessions];
      after = next.after;
    }
    if (mine !== search) return;
    shelf.value = {sessions, total, after, search: mine};
    complaint.value = null;
  } catch (error) {
    if (mine === search) complaint.value = asApiError(error);
  }
}

/** The next page, where there is one and nobody asks for it already. */
export async function askMore(): Promise<void> {
  const {after, search: mine} = shelf.value;
  if (isAsking || after === null || mine !== search) return;
  isAsking = true;
  try {
    const next = await page(after);
    if (mine !== search) return;
    const sessions = [...shelf.value.sessions, ...next.sessions];
    shelf.value = {...shelf.value, sessions, total: next.total, after: next.after};
  } catch (error) {
    complaint.value = asApiError(error);
  } finally {
    isAsking = false;
  }
}

export async function askTags(): Promise<void> {
  const said = await answer(api.GET('/api/v1/library/tags')).catch(() => null);
  if (said) tags.value = said.tags.map(({tag}) => tag);
}
