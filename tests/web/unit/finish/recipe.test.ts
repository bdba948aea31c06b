// SPDX-License-Identifier: Apache-2.0
import {describe, expect, test} from 'vitest';
import {factsInWords} from '../../../../app/web/src/screens/finish/found';
import {requestOf} from '../../../../app/web/src/screens/finish/making';
import {changed, historyIn, keysOfBox, moved, nothing, type RecipeHistory, recipeOfSet, redone, stepOf, undone, withKeys, without, type StepKind} from '../../../../app/web/src/screens/finish/recipe';
import {maybeIn, numbersIn, spotsIn, textOfSpots} from '../../../../app/web/src/screens/finish/step_form';

const crop: StepKind = {
  name: 'crop', says: 'Cuts',
  keys: ['left_mm', 'top_mm'].map((name) => ({name, says: '', holds: 'number', default: 0, least: 0, most: 100, words: []})),
};
const names = ({now}: RecipeHistory) => now.map((step) => step.do);

describe('a recipe', () => {
  const recipe = [{do: 'flatten'}, {do: 'straighten'}, {do: 'tile'}];

  test('is edited without touching what it was', () => {
    expect(stepOf(crop)).toEqual({do: 'crop', left_mm: 0, top_mm: 0});
    expect(without(recipe, 1)).toEqual([{do: 'flatten'}, {do: 'tile'}]);
    expect(moved(recipe, 2, -1).map((step) => step.do)).toEqual(['flatten', 'tile', 'straighten']);
    expect(moved(recipe, 0, -1)).toBe(recipe);
    expect(moved(recipe, 2, 1)).toBe(recipe);
    expect(withKeys(recipe, 2, {repeats: [2, 2]})[2]).toEqual({do: 'tile', repeats: [2, 2]});
    expect(recipe[2]).toEqual({do: 'tile'});
  });

  test('goes back twenty steps and forth again, also after it was kept as text', () => {
    let history = nothing;
    for (let i = 1; i <= 20; ++i) history = changed(history, [...history.now, {do: 'crop', left_mm: i}]);
    for (let i = 0; i < 20; ++i) history = undone(history);
    expect(history.now).toEqual([]);
    expect(undone(history)).toBe(history);
    const kept = historyIn(JSON.stringify(history));
    expect(kept).toEqual(history);
    let again = kept ?? nothing;
    for (let i = 0; i < 20; ++i) again = redone(again);
    expect(again.now.map((step) => step['left_mm'])).toEqual(Array.from({length: 20}, (_, i) => i + 1));
    expect(redone(again)).toBe(again);
  });

  test('forgets what was taken back once something else is done', () => {
    const two = changed(changed(nothing, [{do: 'flatten'}]), [{do: 'flatten'}, {do: 'tile'}]);
    const other = changed(undone(two), [{do: 'flatten'}, {do: 'crop'}]);
    expect(names(other)).toEqual(['flatten', 'crop']);
    expect(redone(other)).toBe(other);
  });

  test('that is kept and cannot be read is none', () => {
    for (const text of [null, '', '{', '[]', '{"past": [], "now": [{"left": 1}], "future": []}', '{"past": [7], "now": [], "future": []}']) {
      expect(historyIn(text), String(text)).toBeNull();
    }
  });

  test('of a set of maps is without what its steps found', () => {
    const steps = [{do: 'flatten', by: 'corners', facts: {}}, {do: 'tile', repeats: [4, 3], facts: {seam: 0.1}}];
    expect(recipeOfSet({preview: true, steps})).toEqual([{do: 'flatten', by: 'corners'}, {do: 'tile', repeats: [4, 3]}]);
    expect(recipeOfSet(undefined)).toEqual([]);
  });

  test('becomes a preview without further maps, or all maps', () => {
    const steps = {steps: recipe};
    expect(requestOf({session: 'satin', solve: 'ab'}, recipe, true)).toEqual({kind: 'finish', session: 'satin', solve: 'ab', preview: true, steps});
    expect(requestOf({session: 'satin', solve: 'ab', isDraft: true}, recipe, false)).toEqual({kind: 'maps', session: 'satin', solve: 'ab', draft: true, steps});
    expect(requestOf({session: 'satin', solve: ''}, recipe, false)).toEqual({kind: 'maps', session: 'satin', steps});
  });
});

describe('what is typed', () => {
  test('of numbers and spots is what is shown again', () => {
    expect(numbersIn(' 4  3')).toEqual([4, 3]);
    const spots = [{x_mm: 12.5, y_mm: 30, radius_mm: 1.5}, {x_mm: 40, y_mm: 8, radius_mm: 2}];
    expect(spotsIn(textOfSpots(spots))).toEqual(spots);
    expect(spotsIn('')).toEqual([]);
    expect(spotsIn('1 2')[0]?.radius_mm).toBeNaN();
  });

  test('of a number that may be left out is null where nothing is typed', () => {
    expect(maybeIn('-24,5')).toBe(-24.5);
    expect(maybeIn('0')).toBe(0);
    expect(maybeIn(' ')).toBeNull();
  });

  test('by a rectangle is in millimetres', () => {
    const box = {x: 10, y: 20, width: 30, height: 40};
    expect(keysOfBox('crop', box, 0.1, [])).toEqual({left_mm: 1, top_mm: 2, width_mm: 3, height_mm: 4});
    expect(keysOfBox('repair', box, 0.1, [{x_mm: 1, y_mm: 1, radius_mm: 1}])?.['spots']).toEqual([{x_mm: 1, y_mm: 1, radius_mm: 1}, {x_mm: 2.5, y_mm: 4, radius_mm: 2.5}]);
    expect(keysOfBox('tile', box, 0.1, [])).toBeNull();
  });
});

test('facts of a step are said in words, lists are left to the document', () => {
  expect(factsInWords({angle_deg: 0.4217, repeats: 12, found: true, by: 'mean', lattice: [1, 2], why: '', seam_x: {residual: 0.25}})).toBe('angle deg 0.422, repeats 12, found yes, by mean, seam x: residual 0.250');
  expect(factsInWords(undefined)).toBe('');
});
