// SPDX-License-Identifier: Apache-2.0
import type {Summary} from './metadata';

/** The cloth relit, or photographed; an empty place where there is neither. */
export function Thumbnail({session: {thumbnail}}: {session: Summary}) {
  return <div class="thumbnail">{thumbnail && <img src={thumbnail} alt="" loading="lazy" decoding="async" />}</div>;
}
