// SPDX-License-Identifier: Apache-2.0
import type {Summary} from './metadata';

/** The first lit frame; an empty place where there is none. */
export function Thumbnail({session}: {session: Summary}) {
  const hasFrames = session.shots > 0 && session.state !== 'unreadable';
  return (
    <div class="thumbnail">
      {hasFrames && <img src={`/api/v1/sessions/${session.name}/frames/1/thumbnail`} alt="" loading="lazy" decoding="async" />}
    </div>
  );
}
