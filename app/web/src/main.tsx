// SPDX-License-Identifier: Apache-2.0
import './style.css';
import {signal} from '@preact/signals';
import {render} from 'preact';
import {answer, api, asApiError, type ApiError} from './api/client';
import {follow} from './api/events';
import {Countdown, DarkPage} from './frame/dark_page';
import {Entrance, logIn, takeToken} from './frame/entrance';
import {Frame} from './frame/frame';
import {LazyScreen} from './frame/lazy_screen';
import {become, followAddress, place} from './state/address';
import {darkIn_s, isDark} from './state/dark';
import {askForms} from './state/forms';
import {followKeys} from './state/keys';
import {followRig, rig} from './state/rig';
import {followRunningJob} from './state/running_job';

type Entry = {is: 'coming'} | {is: 'refused'; error: ApiError; token: string} | {is: 'in'};
const entry = signal<Entry>({is: 'coming'});

/** A rig that has scanned begins at its desk, where no click is lost; who has scanned nothing yet, by looking at cloth. */
async function firstScreen(): Promise<string> {
  if (!hasLeds()) return '/tour';
  const {total} = await answer(api.GET('/api/v1/sessions', {params: {query: {limit: 1}}}));
  return total === 0 ? '/tour' : '/desk';
}

async function begin(): Promise<void> {
  await Promise.all([followRig(), askForms()]);
  if (place.value.screen === '') become(await firstScreen().catch(() => '/desk'));
  followRunningJob();
  follow();
  entry.value = {is: 'in'};
}

async function comeIn(token: string): Promise<void> {
  try {
    if (token !== '') await logIn(token);
    await begin();
  } catch (error) {
    entry.value = {is: 'refused', error: asApiError(error), token};
  }
}

function hasLeds(): boolean {
  return rig.value?.devices.board.leds !== 0;
}

/** Without LEDs there is nothing to do at a desk: the tour leads to a rig. */
function screenFor(asked: string): string {
  return asked === 'desk' && !hasLeds() ? 'tour' : asked;
}

/** While it is dark the screens stay as they are, unseen, so that nothing typed is lost. */
function Page() {
  if (entry.value.is === 'coming') return null;
  if (entry.value.is === 'refused') return <Entrance error={entry.value.error} linked={entry.value.token} onEntered={begin} />;
  return (
    <>
      <div class={isDark.value ? 'frame covered' : 'frame'} inert={isDark.value}>
        <Frame><LazyScreen name={screenFor(place.value.screen)} /></Frame>
      </div>
      {isDark.value && <DarkPage />}
      {darkIn_s.value != null && <Countdown from_s={darkIn_s.value} />}
    </>
  );
}

followAddress();
followKeys();
render(<Page />, document.body);
void comeIn(takeToken());
