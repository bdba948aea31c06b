// SPDX-License-Identifier: Apache-2.0
// Black and still while the rig exposes. A key or a touch shows how things are for a moment, at the price of some light.
import {useEffect, useRef, useState} from 'preact/hooks';
import {answer, api} from '../api/client';
import {connection, rig} from '../state/rig';
import {sound} from '../state/tone';
import {durationOf} from '../ui/words';
import {silenceInWords, stateInWords} from './rig_words';

const glimpse_ms = 2000;

function knownInWords(): string {
  const {age_s} = connection.value;
  if (age_s > 0 || !rig.value) return silenceInWords(age_s);
  const {frames, frames_planned, left_s} = rig.value;
  return `${stateInWords(rig.value)}, ${frames} of ${frames_planned}${left_s === null ? '' : `, ${durationOf(left_s)} left`}.`;
}

/** Says that it will be dark, before it is. */
export function Countdown({from_s}: {from_s: number}) {
  const [count, setCount] = useState(3);
  useEffect(() => {
    const timer = setInterval(() => setCount((before) => before - 1 || 1), (from_s * 1000) / 3);
    return () => clearInterval(timer);
  }, []);
  return <p class="panel soon" role="status">Dark in {count}</p>;
}

function cancelScan(): void {
  answer(api.POST('/api/v1/scan/cancel', {body: {}})).catch(() => {});
}

export function DarkPage() {
  const page = useRef<HTMLDivElement>(null);
  const [glimpse, setGlimpse] = useState<'none' | 'status' | 'cancel'>('none');
  const timer = useRef(0);
  useEffect(() => {
    page.current?.focus();
    return () => {
      clearTimeout(timer.current);
      // A test shot is over before anybody looks away.
      if (rig.value?.dark === false && rig.value.state !== 'attended') sound();
    };
  }, []);

  const show = (what: 'status' | 'cancel') => {
    setGlimpse(what);
    clearTimeout(timer.current);
    timer.current = window.setTimeout(() => setGlimpse('none'), glimpse_ms);
  };
  const press = (event: KeyboardEvent) => {
    event.stopPropagation();
    event.preventDefault();
    if (event.key === 'Enter' && glimpse === 'cancel') cancelScan();
    else show(event.key === 'Escape' ? 'cancel' : 'status');
  };
  return (
    <div ref={page} class="dark" role="application" tabIndex={-1} aria-label="The screen is dark while the rig exposes"
      onKeyDown={press} onPointerDown={() => show('status')}>
      {glimpse !== 'none' && (
        <p>
          {knownInWords()} This light may spoil the shot.
          {glimpse === 'cancel' && ' Enter cancels the scan; what is photographed is kept.'}
        </p>
      )}
    </div>
  );
}
