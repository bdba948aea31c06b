// SPDX-License-Identifier: Apache-2.0
// What is said of a cloth, as a form holds it, and the change that it amounts to.
import type {Schemas} from '../../api/client';
import {numberIn, textIn, textsIn} from '../../ui/fields';

export type Summary = Schemas['Summary'];
export type MetadataChange = Schemas['MetadataChange'];

const texts = ['fabric', 'id', 'composition', 'construction', 'side', 'kind', 'notes'] as const;
const numbers = ['weight_g_m2', 'thickness_mm'] as const;

export type FormField = (typeof texts)[number] | (typeof numbers)[number];
export type MetadataTexts = Record<FormField, string> & {tags: string[]};

export const fields: {field: FormField; label: string; unit?: string}[] = [
  {field: 'fabric', label: 'Fabric'},
  {field: 'id', label: 'Article or barcode'},
  {field: 'composition', label: 'Composition'},
  {field: 'construction', label: 'Construction'},
  {field: 'side', label: 'Side'},
  {field: 'kind', label: 'Kind'},
  {field: 'weight_g_m2', label: 'Weight', unit: 'g/m²'},
  {field: 'thickness_mm', label: 'Thickness', unit: 'mm'},
  {field: 'notes', label: 'Notes'},
];

/** What people said of a cloth, and how often that was changed. */
export type Said = Pick<Summary, FormField | 'tags' | 'revision'>;

/** Null: the session's document cannot be read. */
export function saidOf({fabric, said}: Schemas['Session']): Said | null {
  if (!said) return null;
  return {
    fabric,
    id: textIn(said, 'id'),
    composition: textIn(said, 'composition'),
    construction: textIn(said, 'construction'),
    side: textIn(said, 'side'),
    kind: textIn(said, 'kind'),
    notes: textIn(said, 'notes'),
    weight_g_m2: numberIn(said, 'weight_g_m2'),
    thickness_mm: numberIn(said, 'thickness_mm'),
    tags: textsIn(said, 'tags'),
    revision: numberIn(said, 'revision') ?? 0,
  };
}

export function formOf(session: Said): MetadataTexts {
  const number = (value: number | null) => (value === null ? '' : String(value));
  return {
    fabric: session.fabric,
    id: session.id,
    composition: session.composition,
    construction: session.construction,
    side: session.side,
    kind: session.kind,
    notes: session.notes,
    weight_g_m2: number(session.weight_g_m2),
    thickness_mm: number(session.thickness_mm),
    tags: session.tags,
  };
}

/** The fields that differ, null where one was emptied; a field that is no number stays as it was. */
export function changeBetween(before: MetadataTexts, after: MetadataTexts): MetadataChange {
  const change: MetadataChange = {};
  for (const field of texts) {
    if (after[field] !== before[field]) change[field] = after[field] === '' ? null : after[field];
  }
  for (const field of numbers) {
    if (after[field] !== before[field] && !problemWith(field, after[field]))
      change[field] = after[field] === '' ? null : Number(after[field]);
  }
  if (after.tags.join('\n') !== before.tags.join('\n')) change.tags = after.tags;
  return change;
}

export function problemWith(field: FormField, value: string): string {
  const is_number = (numbers as readonly string[]).includes(field);
  return is_number && value !== '' && !(Number(value) > 0) ? 'must be a number above 0' : '';
}

/** Tags as somebody types them: between commas. */
export function tagsIn(text: string): string[] {
  return text
    .split(',')
    .map((tag) => tag.trim())
    .filter((tag) => tag !== '');
}

export function withTags(tags: readonly string[], added: readonly string[]): string[] {
  return [...new Set([...tags, ...added])];
}

export function withoutTag(tags: readonly string[], removed: string): string[] {
  return tags.filter((tag) => tag !== removed);
}
