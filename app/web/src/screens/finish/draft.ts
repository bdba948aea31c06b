// SPDX-License-Identifier: Apache-2.0
// The recipe that is worked on of each session, with its steps back, kept by this browser: it outlives a reload and
// whatever ends the daemon. Another browser begins with the steps of a set of maps.
import {signal, type Signal} from '@preact/signals';
import {changed, historyIn, nothing, redone, undone, type History, type Recipe} from './recipe';

export class Draft {
  readonly history: Signal<History>;
  private readonly key: string;

  constructor(session: string, first: Recipe) {
    this.key = `weft.finish.${session}`;
    this.history = signal(historyIn(localStorage.getItem(this.key)) ?? {...nothing, now: first});
  }

  change(to: Recipe): void {
    this.take(changed(this.history.value, to));
  }

  undo(): void {
    this.take(undone(this.history.value));
  }

  redo(): void {
    this.take(redone(this.history.value));
  }

  private take(history: History): void {
    this.history.value = history;
    localStorage.setItem(this.key, JSON.stringify(history));
  }
}
