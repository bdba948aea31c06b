// SPDX-License-Identifier: Apache-2.0

export interface Place {
  /** The first word of the path: desk, sessions, viewer ... Empty at the bare address. */
  screen: string;
  /** The other words, decoded. */
  parts: string[];
  query: URLSearchParams;
}

/** What an address of the page stands for; people type /library, as its tab is called. */
export function placeOf(address: URL): Place {
  const [screen = '', ...parts] = address.pathname.split('/').slice(1).map(decodeURIComponent);
  return {screen: screen === 'library' ? 'sessions' : screen, parts: parts.filter((part) => part !== ''), query: address.searchParams};
}
