// SPDX-License-Identifier: Apache-2.0
// The LEDs of the rig by number, each with what it does in a word and a shape; pressed, one is lit to look by.
import type {Schemas} from '../../api/client';
import {rig} from '../../state/rig';
import {Mark, type Verdict} from '../../ui/mark';
import {percentOf} from '../../ui/words';
import {light, looks} from './devices';

type LedStatus = Schemas['Status']['leds'][number];

const codes: Record<string, string> = {
  dark: 'did not light',
  dim: 'dim',
  swapped: 'another LED lit',
  stays_lit: 'another stays lit',
  room_light: 'room light',
  changed: 'changed',
  clipped: 'clipped',
  damaged: 'damaged file',
  unlike: 'unlike the others',
};
const states: Record<LedStatus['state'], {verdict: Verdict; word: string}> = {
  waiting: {verdict: 'waiting', word: 'waits'},
  exposing: {verdict: 'busy', word: 'exposing'},
  checking: {verdict: 'busy', word: 'checking'},
  kept: {verdict: 'fine', word: 'kept'},
  refused: {verdict: 'fault', word: 'refused'},
};

interface Cell {
  verdict: Verdict;
  word: string;
  more: string;
}

function cellOf(led: LedStatus | undefined): Cell {
  if (!led) return {verdict: 'waiting', word: 'dark', more: ''};
  const {verdict, word} = states[led.state];
  const takes = led.takes > 1 ? `take ${led.takes}` : '';
  if (led.code === '') return {verdict, word, more: takes};
  const clipped = led.code === 'clipped' ? ` ${percentOf(led.clipped)}` : '';
  return {verdict: led.state === 'refused' ? 'fault' : 'warning', word: `${codes[led.code] ?? led.code}${clipped}`, more: takes};
}

export function lightLed(led: number): void {
  light.value = light.value === led ? 'round' : led;
}

export function LedStrip() {
  const status = rig.value;
  if (!status) return null;
  const numbers = Array.from({length: status.devices.board.leds}, (_, index) => index + 1);
  return (
    <ol class="leds" aria-label="LEDs">
      {numbers.map((number) => {
        const isLit = status.lit.includes(number);
        const {verdict, word, more} = cellOf(status.leds.find(({led}) => led === number));
        return (
          <li key={number}>
            <button type="button" class={isLit ? 'led lit' : 'led'} disabled={!looks.value} aria-pressed={light.value === number}
              onClick={() => lightLed(number)}>
              <span class="number">{number}</span>
              <Mark verdict={isLit ? 'busy' : verdict}>{isLit ? 'lit' : word}</Mark>
              {more && <span class="dim">{more}</span>}
            </button>
          </li>
        );
      })}
    </ol>
  );
}
