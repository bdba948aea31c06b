// SPDX-License-Identifier: Apache-2.0
import type {ComponentChildren} from 'preact';

/** A place with nothing in it yet: says so, and what to do next. */
export function Empty({says, children}: {says: string; children?: ComponentChildren}) {
  return (
    <div class="empty">
      <p>{says}</p>
      {children}
    </div>
  );
}
