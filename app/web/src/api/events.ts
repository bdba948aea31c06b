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
export type Kind = keyof Events;

const kinds: Kind[] = ['status', 'frame', 'job', 'shot', 'control', 'calibration', 'gap', 'heartbeat'];
const delays_s = [1, 2, 5, 10];
const silence_s = 20;

export interface Connection {
  /** silent: no word for so long that what is shown may be old. */
  state: 'connecting' | 'live' | 'silent';
  /** Since the last word. */
  age_s: number;
}
export const connection = signal<Connection>({state: 'connecting', age_s: 0});

type Handler = (data: unknown) => void;
const handlers = new Map<Kind, Set<Handler>>();

/** Calls `handle` with each event of this kind; returns what ends that. */
export function onEvent<K extends Kind>(kind: K, handle: (data: Events[K]) => void): () => void {
  const those = handlers.get(kind) ?? new Set<Handler>();
  handlers.set(kind, those.add(handle as Handler));
  return () => those.delete(handle as Handler);
}

interface Message {
  kind: Kind;
  data: unknown;
}

let lastWord = Date.now();

function hear({kind, data}: Message): void {
  lastWord = Date.now();
  connection.value = {state: 'live', age_s: 0};
  handlers.get(kind)?.forEach((handle) => handle(data));
}

function watchSilence(): void {
  setInterval(() => {
    const age_s = Math.floor((Date.now() - lastWord) / 1000);
    if (age_s >= silence_s) connection.value = {state: 'silent', age_s};
  }, 1000);
}

/** Listens until it is told to stop, and begins anew after every fault. What may have been missed is a gap. */
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

  private take(kind: Kind, text: string): void {
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
  const turn = () => (document.hidden ? listener.stop() : listener.start());
  document.addEventListener('visibilitychange', turn);
  if (!document.hidden) listener.start();
}

/** Begins; to be called once, after somebody was let in. */
export function follow(): void {
  watchSilence();
  // The type says that it is always there; a plain http page of another machine has none.
  const locks = navigator.locks as LockManager | undefined;
  if (locks) listenForAll(locks);
  else listenWhileSeen();
}
