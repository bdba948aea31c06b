// SPDX-License-Identifier: Apache-2.0
import {describe, expect, test} from 'vitest';
import {addressOf, filtersIn, isNarrowed, noFilters, questionOf} from '../../../../app/web/src/screens/sessions/filters';

describe('filters of the library', () => {
  test('survive a trip through the address', () => {
    const filters = {...noFilters, words: 'wool red', tag: 'autumn', from: '2026-11-01', warned: true};
    const address = new URLSearchParams();
    for (const [key, value] of Object.entries(addressOf(filters))) if (value !== null) address.set(key, value);
    expect(filtersIn(address)).toEqual(filters);
  });

  test('ask the daemon only what it knows', () => {
    expect(questionOf({...noFilters, words: '  twill ', state: 'complete', warned: true})).toEqual({query: 'twill', state: 'complete', warned: 'true'});
  });

  test('leave everything where nothing is asked', () => {
    expect(isNarrowed(noFilters)).toBe(false);
    expect(isNarrowed({...noFilters, words: ' '})).toBe(false);
    expect(isNarrowed({...noFilters, warned: true})).toBe(true);
    expect(Object.values(addressOf(noFilters)).every((value) => value === null)).toBe(true);
  });
});
