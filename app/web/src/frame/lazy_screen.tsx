// SPDX-License-Identifier: Apache-2.0
import type {ComponentType} from 'preact';
import {useEffect, useRef, useState} from 'preact/hooks';
import {connection, heardAt, onEvent} from '../api/events';
import {place} from '../state/address';
import {Complaint} from '../ui/complaint';
import {Button} from '../ui/button';
import {useLatest} from '../ui/use_latest';

type Load = () => Promise<{default: ComponentType}>;

/** Each is a file of its own, fetched when it is first shown. */
const screens: Record<string, Load> = {
  desk: () => import('../screens/desk/desk_screen'),
  sessions: () => import('../screens/sessions/sessions_screen'),
  viewer: () => import('../screens/viewer/viewer_screen'),
  material: () => import('../screens/material/material_screen'),
  calibrate: () => import('../screens/calibrate/calibrate_screen'),
  batches: () => import('../screens/batches/batches_screen'),
  jobs: () => import('../screens/jobs/jobs_screen'),
  doctor: () => import('../screens/doctor/doctor_screen'),
  tour: () => import('../screens/tour/tour_screen'),
};

function NoSuchScreen() {
  return (
    <section class="page">
      <h1>There is no page {place.value.screen}</h1>
      <p>Go to the <a href="/sessions">library</a>, or <a href="/tour">look around</a>.</p>
    </section>
  );
}

/** A browser remembers that it could not fetch a file, so that only the page as a whole is fetched again. */
function NotLoaded() {
  useBack(() => location.reload());
  return (
    <section class="page">
      <Complaint error={{what: 'This screen cannot be fetched.', where: '', why: 'The daemon does not answer, or is of another version by now.', remedy: 'Reload the page.'}}>
        <Button onClick={() => location.reload()}>Reload</Button>
      </Complaint>
    </section>
  );
}

/** Calls `back` when the daemon is heard again. */
function useBack(back: () => void): void {
  const current = useRef(back);
  current.current = back;
  useEffect(() => onEvent('gap', () => {
    if (connection.peek().state !== 'connecting') current.current();
  }), []);
}

/** How often the daemon came back after one had gone to this address in vain. */
function useArrivals(): number {
  const [arrivals, setArrivals] = useState(0);
  const arrived = useRef(0);
  const {screen, parts} = place.value;
  useEffect(() => {
    arrived.current = Date.now();
  }, [screen, parts.join('/')]);
  useBack(() => {
    if (arrived.current >= heardAt()) setArrivals((before) => before + 1);
  });
  return arrivals;
}

/** What was first asked for while the daemon was gone is asked for again once it is back. */
export function LazyScreen({name}: {name: string}) {
  const [shown, show] = useState<{name: string; Screen: ComponentType} | null>(null);
  const arrivals = useArrivals();
  useLatest((latest) => {
    const load = Object.hasOwn(screens, name) ? screens[name] : undefined;
    if (!load) return show({name, Screen: NoSuchScreen});
    latest(load()).then((module) => show({name, Screen: module.default}), () => show({name, Screen: NotLoaded}));
  }, [name]);
  return shown?.name === name ? <shown.Screen key={arrivals} /> : null;
}
