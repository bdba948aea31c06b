// SPDX-License-Identifier: Apache-2.0
import {clothOf} from '../state/cloths';

/** A session by what its cloth is called, and by its own name where that is another. */
export function ClothName({session}: {session: string}) {
  const cloth = clothOf(session);
  return cloth === session ? <>{session}</> : <>{cloth} <span class="dim">{session}</span></>;
}
