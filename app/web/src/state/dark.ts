// SPDX-License-Identifier: Apache-2.0
// A screen gives up to a sixth of a LED's light, and what changes is in no dark photograph. So from before the first
// exposure to the close of the last every page is black and still. The daemon says when, and waits for it. Without its
// word nobody knows, and the page is light.
import {computed} from '@preact/signals';
import {connection, rig} from './rig';

export const isDark = computed(() => rig.value?.dark === true && connection.value.state !== 'silent');

/** Seconds from when it is said until it is dark, at the least; null, undefined: it is not about to be. */
export const darkIn_s = computed(() => (connection.value.state === 'silent' ? null : rig.value?.dark_in_s));
