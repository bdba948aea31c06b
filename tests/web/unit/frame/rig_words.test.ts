// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import type {Schemas} from '../../../../app/web/src/api/client';
import {stateInWords, verdictOf} from '../../../../app/web/src/frame/rig_words';

type Status = Schemas['Status'];

const attended = {state: 'attended', led: 0, error: null} as Status;
const error = {what: 'LED 3 is dark'} as Status['error'];
const said = (status: Status) => [verdictOf(status), stateInWords(status)];

test('a rig whose last scan failed is not called ready, whether its devices are open or not', () => {
  expect(said({...attended, state: 'idle'})).toEqual(['fine', 'ready']);
  expect(said(attended)).toEqual(['fine', 'ready, devices open']);
  expect(said({...attended, state: 'failed', error})).toEqual(['fault', 'stopped by a fault']);
  expect(said({...attended, error})).toEqual(['fault', 'stopped by a fault, devices open']);
});

test('a scan is said by what it does, and a device that it waits for is a warning', () => {
  const scanning = {...attended, state: 'scanning', phase: 'exposing', led: 7} as Status;
  expect(said(scanning)).toEqual(['busy', 'photographing LED 7']);
  expect(said({...scanning, led: 0})).toEqual(['busy', 'photographing the dark shot']);
  expect(said({...scanning, phase: 'recovering'})).toEqual(['warning', 'waiting for a device']);
});
