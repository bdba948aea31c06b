// SPDX-License-Identifier: Apache-2.0
import {describe, expect, test} from 'vitest';
import {mostRows, rowsInView} from '../../../../app/web/src/ui/virtual_list';

describe('rows in view', () => {
  test('are those that can be seen and some beyond', () => {
    const {first, end} = rowsInView({top_px: 7200, height_px: 720}, 72, 1000);
    expect(first).toBeLessThanOrEqual(100);
    expect(end).toBeGreaterThanOrEqual(111);
  });

  test('are all of a short list', () => expect(rowsInView({top_px: 0, height_px: 720}, 72, 3)).toEqual({first: 0, end: 3}));

  test('end with the list', () => expect(rowsInView({top_px: 1e6, height_px: 720}, 72, 1000).end).toBe(1000));

  test('are never more than agreed, however high the window', () => {
    for (let top_px = 0; top_px < 72_000; top_px += 997) {
      const {first, end} = rowsInView({top_px, height_px: 9000}, 72, 1000);
      expect(end - first).toBeLessThanOrEqual(mostRows);
      expect(first).toBeGreaterThanOrEqual(0);
    }
  });
});
