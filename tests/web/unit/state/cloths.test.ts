// SPDX-License-Identifier: Apache-2.0
import {beforeEach, describe, expect, test, vi} from 'vitest';

const GET = vi.fn();
vi.mock('../../../../app/web/src/api/calls', () => ({api: {GET}}));

const answerWith = (sessions: {name: string; fabric: string}[]) => Promise.resolve({data: {sessions}, response: {ok: true}});
const settled = () => new Promise((done) => setTimeout(done));

describe('the cloth of a session', () => {
  let cloths: typeof import('../../../../app/web/src/state/cloths');
  beforeEach(async () => {
    vi.resetModules();
    GET.mockReset();
    cloths = await import('../../../../app/web/src/state/cloths');
  });

  test('has the name that people gave it, once that is known', async () => {
    GET.mockImplementation(() => answerWith([{name: 'a_001', fabric: 'Grüner Loden'}, {name: 'b_001', fabric: ''}]));
    expect(cloths.clothOf('a_001')).toBe('a_001');
    await settled();
    expect(cloths.clothOf('a_001')).toBe('Grüner Loden');
    expect(cloths.clothOf('b_001')).toBe('b_001');
    expect(GET).toHaveBeenCalledTimes(1);
  });

  test('that is not among the newest is asked for by its name, once', async () => {
    GET.mockImplementation((_, {params}) => answerWith(params.query.query === 'old_007' ? [{name: 'old_007', fabric: '綿'}] : []));
    cloths.clothOf('old_007');
    cloths.clothOf('old_007');
    await settled();
    expect(cloths.clothOf('old_007')).toBe('綿');
    expect(GET).toHaveBeenCalledTimes(2);
  });

  test('is asked for again after a request that failed, and after the daemon changed it', async () => {
    GET.mockImplementationOnce(() => Promise.reject(new Error('gone')));
    GET.mockImplementation(() => answerWith([{name: 'a_001', fabric: 'satin'}]));
    cloths.clothOf('a_001');
    await settled();
    cloths.clothOf('a_001');
    await settled();
    expect(cloths.clothOf('a_001')).toBe('satin');
    GET.mockImplementation(() => answerWith([{name: 'a_001', fabric: 'silk'}]));
    cloths.forgetCloths();
    cloths.clothOf('a_001');
    await settled();
    expect(cloths.clothOf('a_001')).toBe('silk');
  });

  test('is called what it was renamed to', () => {
    cloths.hearOfCloths([{name: 'a_001', fabric: 'satin'}]);
    expect(cloths.clothOf('a_001')).toBe('satin');
    cloths.hearOfCloths([{name: 'a_001', fabric: 'silk'}]);
    expect(cloths.clothOf('a_001')).toBe('silk');
  });
});
