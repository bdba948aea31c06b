// SPDX-License-Identifier: Apache-2.0
// One stream of events for all tabs of this browser. A browser gives a host six connections, all tabs together, so the
// tab that holds the lock listens and tells the others over a channel. Without locks (plain http to another machine)
// each tab listens for itself for as long as it is seen.
import {signal} from '@preact/signals';
import type {Schemas} from './client';

/** What the daemon tells, by kind. */
export interface Events {
  status: Schemas['Status'];
  frame: Schemas['FrameEvent'];
  job: Schemas['JobEvent'];
  shot: Schemas['TestShot'];
  control: Schemas['ControlEvent'];
  /** The set of photographs that is worked on, after each change. */
  calibration: Schemas['PhotographSet'];
  /** Something was missed: ask for the whole state again. */
  gap: Record<string, never>;
  heartbeat: Record<string, never>;
}
export type EventKind = keyof Events;

const kinds: EventKind[] = ['status', 'frame', 'job', 'shot', 'control', 'calibration', 'gap', 'heartbeat'];
const delays_s = [0.2, 1, 2, 5, 10];
/** The daemon says something every second. */
const silence_s = 2.5;
const look_ms = 250;
const usual_s = 2;

export interface Connection {
  /** silent: it is broken, or there was no word for so long that what is shown may be old. */
  state: 'connecting' | 'live' | 'silent';
  /** Since the last word, whole seconds; 0 as long as that is usual. */
  age_s: number;
}
export const connection = signal<Connection>({state: 'connecting', age_s: 0});

type Handler = (data: unknown) => void;
const handlers = new Map<EventKind, Set<Handler>>();

/** Calls `handle` with each event of this kind; returns what ends that. */
export function onEvent<K extends EventKind>(kind: K, handle: (data: Events[K]) => void): () => void {
  const those = handlers.get(kind) ?? new Set<Handler>();
  handlers.set(kind, those.add(handle as Handler));
  return () => those.delete(handle as Handler);
}

interface Message {
  /** broken: the daemon cannot be reached. */
  kind: EventKind | 'broken';
  data: unknown;
}

let lastWord = Date.now();
let silent_ms = 0;

/** When the daemon was last heard. */
export function heardAt(): number {
  return lastWord;
}

function tellSilence(state: Connection['state']): void {
  const age_s = silent_ms < usual_s * 1000 ? 0 : Math.floor(silent_ms / 1000);
  const {state: before, age_s: age_before_s} = connection.peek();
  if (state !== before || age_s !== age_before_s) connection.value = {state, age_s};
}

/** After a gap it is live again by the word that follows, for until then what is known is old. */
function hear({kind, data}: Message): void {
  if (kind === 'broken') return tellSilence('silent');
  handlers.get(kind)?.forEach((handle) => handle(data));
  if (kind === 'gap') return;
  lastWord = Date.now();
  silent_ms = 0;
  tellSilence('live');
}

/** What a page slept itself is no silence of the daemon. */
function watchSilence(): void {
  let before = Date.now();
  setInterval(() => {
    const now = Date.now();
    silent_ms += Math.min(now - before, 2 * look_ms);
    before = now;
    tellSilence(silent_ms >= silence_s * 1000 ? 'silent' : connection.peek().state);
  }, look_ms);
}

/**
 * Listens until it is told to stop, and begins anew after every fault: at once where it listened, so that a hiccup is
 * none. What may have been missed is a gap.
 */
class Listener {
  private source: EventSource | null = null;
  private timer = 0;
  private failures = 0;

  constructor(private readonly tell: (message: Message) => void) {}

  start(): void {
    const source = new EventSource('/api/v1/events?screen=1');
    this.source = source;
    source.onopen = () => {
      this.failures = 0;
      this.tell({kind: 'gap', data: {}});
    };
    source.onerror = () => this.again();
    for (const kind of kinds) {
      source.addEventListener(kind, (event) => this.take(kind, (event as MessageEvent<string>).data));
    }
  }

  stop(): void {
    clearTimeout(this.timer);
    this.source?.close();
    this.source = null;
  }

  private take(kind: EventKind, text: string): void {
    this.expectHeartbeat();
    this.tell({kind, data: JSON.parse(text)});
  }

  /** A connection can be gone without a word of it. */
  private expectHeartbeat(): void {
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.again(), silence_s * 1000);
  }

  private again(): void {
    this.stop();
    if (this.failures > 0) this.tell({kind: 'broken', data: {}});
    const delay_s = delays_s[Math.min(this.failures++, delays_s.length - 1)] ?? 10;
    this.timer = window.setTimeout(() => this.start(), delay_s * 1000);
  }
}

function listenForAll(locks: LockManager): void {
  const channel = new BroadcastChannel('weft-events');
  channel.onmessage = (message: MessageEvent<Message>) => hear(message.data);
  const tell = (message: Message) => {
    channel.postMessage(message);
    hear(message);
  };
  void locks.request('weft-events', () => new Promise<never>(() => new Listener(tell).start()));
}

function listenWhileSeen(): void {
  const listener = new Listener(hear);
  const turn = () => {
    if (document.hidden) return listener.stop();
    silent_ms = 0;
    tellSilence('connecting');
    listener.start();
  };
  document.addEventListener('visibilitychange', turn);
  turn();
}

/** Begins; to be called once, after somebody was let in. */
export function follow(): void {
  watchSilence();
  // The type says that it is always there; a plain http page of another machine has none.
  const locks = navigator.locks as LockManager | undefined;
  if (locks) listenForAll(locks);
  else listenWhileSeen();
}
