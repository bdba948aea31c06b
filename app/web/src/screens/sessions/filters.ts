// SPDX-License-Identifier: Apache-2.0
// What the library is searched by. It lives in the address, so that a search can be shared and survives a reload.

export interface Filters {
  words: string;
  tag: string;
  state: string;
  calibration: string;
  from: string;
  to: string;
  warned: boolean;
}

export const noFilters: Filters = {words: '', tag: '', state: '', calibration: '', from: '', to: '', warned: false};
export const states = ['complete', 'capturing', 'unreadable'] as const;
const texts = ['words', 'tag', 'state', 'calibration', 'from', 'to'] as const;

export function filtersIn(query: URLSearchParams): Filters {
  const text = (key: string) => query.get(key) ?? '';
  return {
    words: text('words'),
    tag: text('tag'),
    state: text('state'),
    calibration: text('calibration'),
    from: text('from'),
    to: text('to'),
    warned: query.has('warned'),
  };
}

/** The changes that the address needs; null removes a key. */
export function addressOf(filters: Filters): Record<string, string | null> {
  const changes: Record<string, string | null> = {warned: filters.warned ? '1' : null};
  for (const key of texts) changes[key] = filters[key] || null;
  return changes;
}

/** What the daemon is asked. */
export function questionOf(filters: Filters): Record<string, string> {
  const question: Record<string, string> = filters.warned ? {warned: 'true'} : {};
  for (const key of texts) {
    const value = filters[key].trim();
    if (value) question[key === 'words' ? 'query' : key] = value;
  }
  return question;
}

export function isNarrowed(filters: Filters): boolean {
  return Object.keys(questionOf(filters)).length > 0;
}
