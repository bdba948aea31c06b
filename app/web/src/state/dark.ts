// SPDX-License-Identifier: Apache-2.0
// A screen gives up to a sixth of a LED's light, and what changes is in no dark photograph. So from before the first
// exposure to the close of the last every page is black and still. The daemon says when, and waits for it. Without its
// word nobody knows, and the page is light.
import {computed} from '@preact/signals';
import {connection, rig} from './rig';

export const isDark = computed(() => rig.value?.dark === true && connection.value.state !== 'silent');
