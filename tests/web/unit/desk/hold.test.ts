// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import type {Schemas} from '../../../../app/web/src/api/client';
import {holdOf} from '../../../../app/web/src/screens/desk/hold';

type Held = Parameters<typeof holdOf>[0];
const error = {what: 'the camera is gone'} as Schemas['Status']['error'];
const held = (status: Partial<Held>): Held => ({can: [], state: 'scanning', error: null, ...status});

test('a scan that runs is paused, and a paused one goes on', () => {
  expect(holdOf(held({can: ['pause', 'cancel']}))).toBe('pause');
  expect(holdOf(held({can: ['resume', 'cancel'], state: 'paused'}))).toBe('resume');
});

test('after a fault the scan goes on, with the devices open as well', () => {
  expect(holdOf(held({can: ['scan', 'devices', 'resume'], state: 'failed', error}))).toBe('resume');
  expect(holdOf(held({can: ['scan', 'devices', 'resume', 'light'], state: 'attended', error}))).toBe('resume');
  expect(holdOf(held({can: ['scan', 'devices'], state: 'failed', error}))).toBe(null);
});

test('no key begins what was cancelled again', () => {
  expect(holdOf(held({can: ['scan', 'devices', 'resume'], state: 'idle'}))).toBe(null);
});
