// SPDX-License-Identifier: Apache-2.0
import {computed, signal} from '@preact/signals';
import {isDark} from './dark';

const isVisible = signal(!document.hidden);
document.addEventListener('visibilitychange', () => {
  isVisible.value = !document.hidden;
});

/** Whether anybody can look at this page: its tab is in front, and it is not black for a photograph. */
export const isSeen = computed(() => isVisible.value && !isDark.value);
