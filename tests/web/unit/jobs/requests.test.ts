// SPDX-License-Identifier: Apache-2.0
import {webcrypto} from 'node:crypto';
import {describe, expect, test} from 'vitest';
import {Requests} from '../../../../app/web/src/screens/jobs/jobs';

globalThis.crypto ??= webcrypto as Crypto;  // Node 18 has it by import alone

const solve = {kind: 'solve', session: 'satin', quality: 'fast'};
const never = () => false;

describe('a request', () => {
  test('that is made twice has one id', () => {
    const requests = new Requests();
    expect(requests.idOf(solve, never)).toBe(requests.idOf({...solve}, never));
    expect(requests.idOf(solve, never)).toMatch(/^page-[0-9a-f]{24}$/);
  });

  test('for something else has another one', () => {
    const requests = new Requests();
    expect(requests.idOf(solve, never)).not.toBe(requests.idOf({...solve, quality: 'robust'}, never));
  });

  test('keeps it while its job runs and not after', () => {
    const requests = new Requests();
    const first = requests.idOf(solve, never);
    requests.answered(solve, '000007');
    expect(requests.idOf(solve, (job) => job !== '000007')).toBe(first);
    expect(requests.idOf(solve, (job) => job === '000007')).not.toBe(first);
  });

  test('that was refused is a new one when it is made again', () => {
    const requests = new Requests();
    const first = requests.idOf(solve, never);
    requests.refused(solve);
    expect(requests.idOf(solve, never)).not.toBe(first);
  });
});
