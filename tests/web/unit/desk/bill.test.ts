// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {costOf, gainOf, totalOf, type BillLine} from '../../../../app/web/src/screens/desk/bill';

const lit: BillLine = {what: 'lit', shots: 10, seconds: 25, for: 'Each LED once.', without_deg: null, with_deg: null};
const dark: BillLine = {...lit, what: 'dark', shots: 1, seconds: 2.5};
const repeat: BillLine = {...lit, what: 'repeat', shots: 2, seconds: 5, without_deg: 0.4, with_deg: 0.0013};

test('a line costs its shots, and its seconds where they are known', () => {
  expect(costOf(lit)).toBe('10 shots, 25 s');
  expect(costOf({...dark, seconds: null})).toBe('1 shot');
});

test('a scan costs all of its lines', () => {
  expect(totalOf([lit, dark, repeat])).toBe('13 shots, 33 s');
});

test('the seconds of a scan are not known where those of one line are not', () => {
  expect(totalOf([lit, {...dark, seconds: null}, repeat])).toBe('13 shots');
});

test('what a line gives is the error without and with it, where somebody measured it', () => {
  expect(gainOf(repeat)).toBe('0.40° without, 0.0013° with');
  expect(gainOf({...repeat, with_deg: 0})).toBe('0.40° without, 0° with');
  expect(gainOf({...repeat, without_deg: null})).toBeNull();
});
