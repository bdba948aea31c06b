// SPDX-License-Identifier: Apache-2.0
// Where the page is: what can be shared, survives a reload and is undone by Back.
import {signal} from '@preact/signals';
import {placeOf, type Place} from './place';

export {placeOf, type Place};

export const place = signal<Place>(placeOf(new URL(location.href)));

function arrive(): void {
  place.value = placeOf(new URL(location.href));
}

/** To another place, which Back leaves again unless it stands for this one. */
export function go(path: string, replace = false): void {
  history[replace ? 'replaceState' : 'pushState'](null, '', path);
  arrive();
}

/** The same place by its whole path. */
export function become(path: string): void {
  go(path + location.search, true);
}

/** The query of this place with some of its words changed (null: taken out). */
export function amend(changes: Record<string, string | null>, replace = true): void {
  const address = new URL(location.href);
  for (const [name, value] of Object.entries(changes)) {
    if (value === null) address.searchParams.delete(name);
    else address.searchParams.set(name, value);
  }
  history[replace ? 'replaceState' : 'pushState'](null, '', address);
  arrive();
}

/** Where a link leads, without a new page. */
function followLink(event: MouseEvent): void {
  const link = (event.target as Element).closest('a');
  const isPlain = event.button === 0 && !event.ctrlKey && !event.metaKey && !event.shiftKey && !event.altKey;
  const isOurs = link?.origin === location.origin && !link.pathname.startsWith('/api/') && !link.target && !link.download;
  if (!link || !isPlain || !isOurs || event.defaultPrevented) return;
  event.preventDefault();
  go(link.pathname + link.search);
}

/** Begins to follow Back, Forward and links. */
export function followAddress(): void {
  addEventListener('popstate', arrive);
  addEventListener('click', followLink);
}
