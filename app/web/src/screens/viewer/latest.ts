// SPDX-License-Identifier: Apache-2.0

/**
 * Asks one question at a time, at most one in `pause_ms`, and of those that come meanwhile only the last. Answers come
 * with their question, since by then another may be wanted.
 */
export class Latest<Question, Answer> {
  private waiting: {question: Question} | null = null;
  private isBusy = false;
  private last_ms = -Infinity;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly ask: (question: Question) => Promise<Answer>,
    private readonly take: (answer: Answer, question: Question) => void,
    private readonly complain: (error: unknown) => void,
    private readonly pause_ms: number,
  ) {}

  want(question: Question): void {
    this.waiting = {question};
    this.goOn();
  }

  /** What is asked already is still answered. */
  forget(): void {
    this.waiting = null;
    clearTimeout(this.timer);
    this.timer = undefined;
  }

  private goOn(): void {
    if (this.isBusy || this.timer !== undefined || !this.waiting) return;
    const rest_ms = this.last_ms + this.pause_ms - performance.now();
    if (rest_ms > 0) {
      this.timer = setTimeout(() => {
        this.timer = undefined;
        this.goOn();
      }, rest_ms);
      return;
    }
    const {question} = this.waiting;
    this.waiting = null;
    void this.askNow(question);
  }

  private async askNow(question: Question): Promise<void> {
    this.isBusy = true;
    this.last_ms = performance.now();
    try {
      this.take(await this.ask(question), question);
    } catch (error) {
      this.complain(error);
    }
    this.isBusy = false;
    this.goOn();
  }
}
