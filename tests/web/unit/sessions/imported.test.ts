// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {importedOf} from '../../../../app/web/src/screens/sessions/imported';

const session = (name: string, error: unknown = null) => ({session: `/archive/${name}.weft`, error});

test('names each of a few sessions, refused ones too, and files that are left over', () => {
  const result = {
    sessions: [session('a'), session('b', {what: 'frames are missing'})],
    oddities: [{kind: 'refused', says: '1 session is refused.'}, {kind: 'left_over', says: '2 files are left over.'}],
  };
  expect(importedOf(result)).toEqual({shown: result.sessions, more: 0, sentences: ['2 files are left over.']});
});

test('says in a sentence each what is odd about many', () => {
  const sessions = Array.from({length: 900}, (_, index) => session(`s${index}`, index % 2 ? {what: 'frames are missing'} : null));
  const {shown, more, sentences} = importedOf({sessions, oddities: [{kind: 'refused', says: '450 sessions are refused.'}]});
  expect(shown.length).toBe(8);
  expect(more).toBe(892);
  expect(sentences).toEqual(['450 sessions are refused.']);
});
