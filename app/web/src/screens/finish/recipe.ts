// SPDX-License-Identifier: Apache-2.0
// A recipe as it is worked on: its steps, and what was changed of them.
import {signal, type Signal} from '@preact/signals';
import type {Schemas} from '../../api/client';
import type {Box} from '../../gl/view';
import {isFields, listIn, textIn} from '../../ui/fields';

export type Step = Schemas['RecipeStep'];
export type Recipe = readonly Step[];
export type StepKind = Schemas['StepKind'];
export type StepKey = StepKind['keys'][number];
export type Recipes = Schemas['Recipes'];

export interface Spot {
  x_mm: number;
  y_mm: number;
  radius_mm: number;
}

/** A step of a kind, with all its keys as they are where nobody says them. */
export function stepOf(kind: StepKind): Step {
  return {do: kind.name, ...Object.fromEntries(kind.keys.map(({name, default: otherwise}) => [name, otherwise]))};
}

export function without(recipe: Recipe, index: number): Recipe {
  return recipe.filter((_, each) => each !== index);
}

/** With the step one place earlier or later; as it was where there is none. */
export function moved(recipe: Recipe, index: number, by: 1 | -1): Recipe {
  const to = index + by;
  const [step, other] = [recipe[index], recipe[to]];
  if (!step || !other) return recipe;
  return recipe.map((each, at) => (at === index ? other : at === to ? step : each));
}

export function withKeys(recipe: Recipe, index: number, keys: Record<string, unknown>): Recipe {
  return recipe.map((step, each) => (each === index ? {...step, ...keys} : step));
}

/** The steps that made a set of maps, without what they found. */
export function recipeOfSet(document: unknown): Recipe {
  return listIn(document, 'steps').filter(isStep).map(({facts, ...step}) => step);
}

export function isStep(value: unknown): value is Step {
  return isFields(value) && textIn(value, 'do') !== '';
}

/** A rectangle of a set of maps as a place to crop to, or as a spot that fills it. Null: the step has no place. */
export function keysOfBox(step: string, box: Box, mm_per_pixel: number, spots: readonly Spot[]): Record<string, unknown> | null {
  const mm = (pixels: number) => Number((pixels * mm_per_pixel).toFixed(3));
  if (step === 'crop') return {left_mm: mm(box.x), top_mm: mm(box.y), width_mm: mm(box.width), height_mm: mm(box.height)};
  if (step !== 'repair') return null;
  const spot = {x_mm: mm(box.x + box.width / 2), y_mm: mm(box.y + box.height / 2), radius_mm: mm(Math.hypot(box.width, box.height) / 2)};
  return {spots: [...spots, spot]};
}

/** A recipe with what it was before and what was taken back, the nearest last. */
export interface RecipeHistory {
  past: readonly Recipe[];
  now: Recipe;
  future: readonly Recipe[];
}

export const nothing: RecipeHistory = {past: [], now: [], future: []};
const mostSteps = 200;

export function changed({past, now}: RecipeHistory, to: Recipe): RecipeHistory {
  return {past: [...past, now].slice(-mostSteps), now: to, future: []};
}

export function undone(history: RecipeHistory): RecipeHistory {
  const before = history.past.at(-1);
  if (!before) return history;
  return {past: history.past.slice(0, -1), now: before, future: [...history.future, history.now]};
}

export function redone(history: RecipeHistory): RecipeHistory {
  const after = history.future.at(-1);
  if (!after) return history;
  return {past: [...history.past, history.now], now: after, future: history.future.slice(0, -1)};
}

/** What was kept of a history; null where it cannot be read. */
export function historyIn(text: string | null): RecipeHistory | null {
  const kept = parsed(text ?? '');
  if (!isFields(kept)) return null;
  const isRecipe = (value: unknown): value is Recipe => Array.isArray(value) && value.every(isStep);
  const {past, now, future} = kept;
  const isList = (value: unknown): value is Recipe[] => Array.isArray(value) && value.every(isRecipe);
  return isList(past) && isRecipe(now) && isList(future) ? {past, now, future} : null;
}

function parsed(text: string): unknown {
  try {
    return JSON.parse(text);
  } catch {
    return null;
  }
}

/**
 * The recipe that is worked on of a session, with its steps back, kept by this browser: it outlives a reload and
 * whatever ends the daemon. Another browser begins with the steps of a set of maps.
 */
export class Draft {
  readonly history: Signal<RecipeHistory>;
  private readonly key: string;

  constructor(session: string, first: Recipe) {
    this.key = `weft.finish.${session}`;
    this.history = signal(historyIn(localStorage.getItem(this.key)) ?? {...nothing, now: first});
  }

  change(to: Recipe): void {
    this.take(changed(this.history.value, to));
  }

  undo(): void {
    this.take(undone(this.history.value));
  }

  redo(): void {
    this.take(redone(this.history.value));
  }

  private take(history: RecipeHistory): void {
    this.history.value = history;
    localStorage.setItem(this.key, JSON.stringify(history));
  }
}
