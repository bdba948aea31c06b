// SPDX-License-Identifier: Apache-2.0
import {afterEach, expect, test, vi} from 'vitest';
import {addressOf, api} from '../../../../app/web/src/api/calls';

function answering(body: string, status = 200) {
  const asked = vi.fn<typeof fetch>(async () => new Response(body, {status}));
  vi.stubGlobal('fetch', asked);
  return asked;
}
afterEach(() => vi.unstubAllGlobals());

test('names of the path and words of the query are encoded, and what is not said is left out', () => {
  const path = {name: 'red/satin', solve: 'a b'};
  expect(addressOf('/sessions/{name}/solves/{solve}', {path})).toBe('/sessions/red%2Fsatin/solves/a%20b');
  expect(addressOf('/jobs', {query: {limit: 20, after: undefined, tag: 'a&b'}})).toBe('/jobs?limit=20&tag=a%26b');
  expect(addressOf('/rig')).toBe('/rig');
});

test('a body is JSON and says so, and a call without one says nothing', async () => {
  const asked = answering('{"session": "satin"}');
  const {data} = await api.POST('/api/v1/scan', {body: {fabric: 'satin'}});
  expect(data).toEqual({session: 'satin'});
  expect(asked.mock.lastCall).toEqual(['/api/v1/scan', {method: 'POST', body: '{"fabric":"satin"}', headers: {'Content-Type': 'application/json'}}]);
  await api.GET('/api/v1/rig');
  expect(asked.mock.lastCall).toEqual(['/api/v1/rig', {method: 'GET', body: undefined, headers: {}}]);
});

test('an error is the document of the daemon, and nothing where something else answers', async () => {
  answering('{"error": {"what": "no"}}', 404);
  expect(await api.GET('/api/v1/rig')).toMatchObject({error: {error: {what: 'no'}}, response: {status: 404}});
  answering('<html>', 502);
  expect((await api.GET('/api/v1/rig')).error).toBeUndefined();
});

test('a text is taken as it is', async () => {
  answering('17');
  const {data} = await api.GET('/api/v1/jobs/{id}/log', {params: {path: {id: '1'}}, parseAs: 'text'});
  expect(data).toBe('17');
});
