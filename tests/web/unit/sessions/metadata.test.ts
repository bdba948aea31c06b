// SPDX-License-Identifier: Apache-2.0
import {describe, expect, test} from 'vitest';
import {leftOut} from '../../../../app/web/src/screens/sessions/one_session';
import {changeBetween, problemWith, tagsIn, withTags, withoutTag, type MetadataTexts} from '../../../../app/web/src/screens/sessions/metadata';

const form: MetadataTexts = {
  fabric: 'satin', id: '', composition: 'silk', construction: '', side: '', notes: '', weight_g_m2: '210', thickness_mm: '', tags: ['red'],
};

describe('a change of metadata', () => {
  test('has nothing where nothing changed', () => expect(changeBetween(form, {...form, tags: ['red']})).toEqual({}));

  test('has what changed, and null for what was emptied', () => {
    const after = {...form, composition: '', notes: 'for the coat', weight_g_m2: '', thickness_mm: '0.4'};
    expect(changeBetween(form, after)).toEqual({composition: null, notes: 'for the coat', weight_g_m2: null, thickness_mm: 0.4});
  });

  test('leaves out a number that is none, and says why', () => {
    expect(changeBetween(form, {...form, weight_g_m2: 'heavy'})).toEqual({});
    expect(problemWith('weight_g_m2', 'heavy')).toMatch(/number/);
    expect(problemWith('notes', 'heavy')).toBe('');
  });

  test('sends all tags once one is another', () => {
    expect(changeBetween(form, {...form, tags: ['red', 'autumn']})).toEqual({tags: ['red', 'autumn']});
  });
});

describe('tags', () => {
  test('are typed between commas', () => expect(tagsIn(' autumn, ,red ')).toEqual(['autumn', 'red']));
  test('are there once', () => expect(withTags(['red'], ['red', 'wool'])).toEqual(['red', 'wool']));
  test('are taken off', () => expect(withoutTag(['red', 'wool'], 'red')).toEqual(['wool']));
});

test('shots are left out and taken in again, each once', () => {
  expect(leftOut([7], 3, true)).toEqual([3, 7]);
  expect(leftOut([3, 7], 3, true)).toEqual([3, 7]);
  expect(leftOut([3, 7], 7, false)).toEqual([3]);
});
