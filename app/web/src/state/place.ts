// SPDX-License-Identifier: Apache-2.0

export interface Place {
  /** The first word of the path: desk, sessions, viewer ... */
  screen: string;
  /** The other words, decoded. */
  parts: string[];
  query: URLSearchParams;
}

/** What an address of the page stands for; the bare one is the desk. */
export function placeOf(address: URL): Place {
  const [screen = '', ...parts] = address.pathname.split('/').slice(1).map(decodeURIComponent);
  return {screen: screen || 'desk', parts: parts.filter((part) => part !== ''), query: address.searchParams};
}
