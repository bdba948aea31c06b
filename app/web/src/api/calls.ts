// SPDX-License-Identifier: Apache-2.0
// The daemon's calls. openapi-fetch has their types; of what it can do at run time this page needs these lines.
import type {Client} from 'openapi-fetch';
import type {paths} from './schema';

interface Asked {
  params?: {path?: Record<string, unknown>; query?: Record<string, unknown>};
  body?: unknown;
  headers?: HeadersInit;
  parseAs?: string;
}

export function addressOf(path: string, {path: names = {}, query = {}}: NonNullable<Asked['params']> = {}): string {
  const words = new URLSearchParams();
  for (const [name, value] of Object.entries(query)) {
    if (value != null) words.append(name, String(value));
  }
  const filled = path.replace(/\{(\w+)\}/g, (_, name: string) => encodeURIComponent(String(names[name])));
  return `${filled}?${words}`.replace(/\?$/, '');
}

function documentOf(text: string): unknown {
  try {
    return JSON.parse(text);
  } catch {
    return undefined;
  }
}

const call = (method: string) => async (path: string, {params, body, headers, parseAs}: Asked = {}) => {
  const json = body === undefined ? undefined : JSON.stringify(body);
  const response = await fetch(addressOf(path, params), {method, body: json, headers: {...(json && {'Content-Type': 'application/json'}), ...headers}});
  const text = await response.text();
  const said = parseAs === 'text' && response.ok ? text : documentOf(text);
  return response.ok ? {data: said, response} : {error: said, response};
};

/** The same origin, always: this page asks nothing of anybody else. */
export const api = {GET: call('GET'), POST: call('POST'), PATCH: call('PATCH'), DELETE: call('DELETE')} as unknown as
  Pick<Client<paths>, 'GET' | 'POST' | 'PATCH' | 'DELETE'>;
