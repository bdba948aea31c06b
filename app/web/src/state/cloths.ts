// SPDX-License-Identifier: Apache-2.0
// What people call the cloths of sessions: a session's own name is one for folders.
import {signal} from '@preact/signals';
import {answer, api, type Schemas} from '../api/client';
import {onEvent} from '../api/events';

type Named = Pick<Schemas['Sessions']['sessions'][number], 'name' | 'fabric'>;

const MOST_AT_ONCE = 1000;

const fabrics = signal<ReadonlyMap<string, string>>(new Map());
const asked = new Set<string>();
let all: Promise<void> | null = null;

/** Remembers what some sessions' cloths are called, as when one was renamed. */
export function hearOfCloths(sessions: readonly Named[]): void {
  fabrics.value = new Map([...fabrics.value, ...sessions.map(({name, fabric}) => [name, fabric] as const)]);
}

/** What is said of cloths was changed in a way that only the daemon knows. */
export function forgetCloths(): void {
  askAgain();
  fabrics.value = new Map();
}

async function ask(query: {query?: string; limit: number}): Promise<void> {
  hearOfCloths((await answer(api.GET('/api/v1/sessions', {params: {query}}))).sessions);
}

/** What was not known or not answered may be by now. */
function askAgain(): void {
  all = null;
  asked.clear();
}
onEvent('gap', askAgain);

/** Those that the archive took last at once, and others one by one. */
async function askFor(session: string): Promise<void> {
  all ??= ask({limit: MOST_AT_ONCE});
  await all;
  if (!fabrics.value.has(session)) await ask({query: session, limit: 20});
}

/** The fabric of a session. Its name where it has none, and until it is known. */
export function clothOf(session: string): string {
  const fabric = fabrics.value.get(session);
  if (fabric === undefined && session !== '' && !asked.has(session)) {
    asked.add(session);
    askFor(session).catch(askAgain);
  }
  return fabric || session;
}
