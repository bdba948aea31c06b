// SPDX-License-Identifier: Apache-2.0
import {expect, test, vi} from 'vitest';

const GET = vi.fn();
vi.mock('../../../../app/web/src/api/calls', () => ({api: {GET}}));

vi.stubGlobal('document', {hidden: false, addEventListener: () => {}});
vi.stubGlobal('localStorage', {getItem: () => null, setItem: () => {}});

const settled = () => new Promise((done) => setTimeout(done));

test('what comes late of a scan does not stand in the place of the one after it', async () => {
  const {rig} = await import('../../../../app/web/src/state/rig');
  const {followScanned, scanned, showsScanned} = await import('../../../../app/web/src/screens/desk/scan');
  const stop = followScanned();
  const answers = new Map<string, (answer: unknown) => void>();
  GET.mockImplementation((_, {params}) => new Promise((answer) => answers.set(params.path.name, answer)));
  const ends = async (session: string) => {
    for (const state of ['scanning', 'ready'])
      rig.value = {state, session, phase: 'complete'} as unknown as typeof rig.value;
    await settled();
  };
  const comes = async (name: string) => {
    answers.get(name)?.({data: {name, histograms_complete: true}, response: {ok: true}});
    await settled();
  };
  await ends('first_001');
  await ends('second_001');
  await comes('second_001');
  await comes('first_001');
  expect(scanned.value?.name).toBe('second_001');
  expect(showsScanned.value).toBe(true);
  stop();
});
