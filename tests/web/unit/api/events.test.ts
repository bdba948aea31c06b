// SPDX-License-Identifier: Apache-2.0
// Who listens hears that the daemon is gone. The stream is the browser's own part, and stands here for it.
import {afterEach, beforeEach, expect, test, vi} from 'vitest';

class Stream {
  static all: Stream[] = [];
  isOpen = true;
  onopen = () => {};
  onerror = () => {};
  private readonly heard = new Map<string, (event: {data: string}) => void>();

  constructor() {
    Stream.all.push(this);
  }
  addEventListener(kind: string, hear: (event: {data: string}) => void) {
    this.heard.set(kind, hear);
  }
  close() {
    this.isOpen = false;
  }
  say(kind: string, data: unknown = {}) {
    this.heard.get(kind)?.({data: JSON.stringify(data)});
  }
}

const last = () => Stream.all.at(-1) as Stream;
let events: typeof import('../../../../app/web/src/api/events');
let dark: typeof import('../../../../app/web/src/state/dark');
let rig: typeof import('../../../../app/web/src/state/rig');

beforeEach(async () => {
  vi.useFakeTimers();
  vi.resetModules();
  Stream.all = [];
  vi.stubGlobal('EventSource', Stream);
  vi.stubGlobal('navigator', {});
  vi.stubGlobal('window', globalThis);
  vi.stubGlobal('document', {hidden: false, addEventListener: () => {}});
  events = await import('../../../../app/web/src/api/events');
  rig = await import('../../../../app/web/src/state/rig');
  dark = await import('../../../../app/web/src/state/dark');
  events.follow();
  rig.rig.value = {dark: true} as NonNullable<typeof rig.rig.value>;
  last().onopen();
  last().say('status', {dark: true});
});
afterEach(() => {
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

const state = () => events.connection.value.state;

test('by a word a second the page stays black', () => {
  for (let second = 0; second < 20; second++) {
    vi.advanceTimersByTime(1200);
    last().say('heartbeat');
  }
  expect([state(), dark.isDark.value]).toEqual(['live', true]);
});

test('without a word the page is light within three seconds, and counts them', () => {
  vi.advanceTimersByTime(2000);
  expect(dark.isDark.value).toBe(true);
  vi.advanceTimersByTime(1000);
  expect([state(), dark.isDark.value]).toEqual(['silent', false]);
  vi.advanceTimersByTime(40_000);
  expect(events.connection.value).toEqual({state: 'silent', age_s: 43});
});

test('a stream that breaks is opened again at once, and the page stays as it was', () => {
  last().onerror();
  vi.advanceTimersByTime(300);
  expect(Stream.all.length).toBe(2);
  last().onopen();
  last().say('status', {dark: true});
  expect([state(), dark.isDark.value]).toEqual(['live', true]);
});

test('a daemon that cannot be reached is known at once', () => {
  last().onerror();
  vi.advanceTimersByTime(300);
  last().onerror();
  expect([state(), dark.isDark.value]).toEqual(['silent', false]);
});

test('a daemon that is back is believed by its first word, not by what it said before', () => {
  const seen: boolean[] = [];
  vi.advanceTimersByTime(3000);
  last().onopen();
  seen.push(dark.isDark.value);
  const stop = events.onEvent('status', (status) => {
    rig.rig.value = status as NonNullable<typeof rig.rig.value>;
    seen.push(dark.isDark.value);
  });
  last().say('status', {dark: false});
  stop();
  expect([...seen, dark.isDark.value, state()]).toEqual([false, false, false, 'live']);
});

test('what the page slept itself is no silence', () => {
  vi.setSystemTime(Date.now() + 3_600_000);
  vi.advanceTimersByTime(250);
  expect(state()).toBe('live');
});
