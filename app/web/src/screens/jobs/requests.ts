// SPDX-License-Identifier: Apache-2.0
// Names of requests: the same one again is the same job, so however often a button is pressed, its work is done once.

/** Works on plain http too, where a browser has no randomUUID. */
function newRequestId(): string {
  const bytes = crypto.getRandomValues(new Uint8Array(12));
  return `page-${[...bytes].map((byte) => byte.toString(16).padStart(2, '0')).join('')}`;
}

interface Asked {
  id: string;
  /** The job that it became; null: the daemon has not answered yet. */
  job: string | null;
}

/** A request keeps its id until its job has ended. */
export class Requests {
  private readonly asked = new Map<string, Asked>();

  idOf(request: object, hasEnded: (job: string) => boolean): string {
    const key = JSON.stringify(request);
    const before = this.asked.get(key);
    if (before && (before.job === null || !hasEnded(before.job))) return before.id;
    const id = newRequestId();
    this.asked.set(key, {id, job: null});
    return id;
  }

  answered(request: object, job: string): void {
    const asked = this.asked.get(JSON.stringify(request));
    if (asked) asked.job = job;
  }

  refused(request: object): void {
    this.asked.delete(JSON.stringify(request));
  }
}
