// SPDX-License-Identifier: Apache-2.0
// What a request may say, by its JSON Schema, as a form needs it.
import {fieldsOf, isFields, listIn, numberIn, textIn, textsIn} from './fields';

export type FieldValue = boolean | number | string | (number | string)[] | Wish[];
/** What somebody said of the fields. */
export interface Wish {
  readonly [field: string]: FieldValue;
}

export type Holds = 'flag' | 'word' | 'words' | 'number' | 'whole' | 'numbers' | 'text' | 'list';

export interface SchemaField {
  name: string;
  holds: Holds;
  says: string;
  /** The only ones; empty: any. */
  words: string[];
  least: number | null;
  /** The least is not among them. */
  isAbove: boolean;
  most: number | null;
  otherwise: FieldValue | null;
  /** What it names: a session, a folder, a file. */
  names: string;
  /** What each thing of a list may say; null: it holds none. */
  each: Schema | null;
  isNeeded: boolean;
}

export interface Schema {
  fields: SchemaField[];
  /** At most one of each pair may be said. */
  apart: [string, string][];
}

function holdsOf(type: string, words: string[], isList: boolean): Holds | null {
  if (words.length > 0) return isList ? 'words' : 'word';
  if (isList) return type === 'number' || type === 'integer' ? 'numbers' : 'words';
  const holds: Record<string, Holds> = {boolean: 'flag', number: 'number', integer: 'whole', string: 'text'};
  return holds[type] ?? null;
}

function fieldOf(name: string, property: unknown, isNeeded: boolean): SchemaField | null {
  const isList = textIn(property, 'type') === 'array';
  const either = listIn(property, 'oneOf')[0];
  const one = isList ? fieldsOf(property)['items'] : (either ?? property);
  const words = textsIn(one, 'enum');
  const isOfThings = isList && textIn(one, 'type') === 'object';
  const holds = isOfThings ? 'list' : holdsOf(textIn(one, 'type'), words, isList);
  if (!holds) return null;
  const above = numberIn(one, 'exclusiveMinimum');
  return {
    name,
    holds,
    says: textIn(property, 'description'),
    words,
    least: above ?? numberIn(one, 'minimum'),
    isAbove: above !== null,
    most: numberIn(one, 'maximum'),
    otherwise: (fieldsOf(property)['default'] as FieldValue | undefined) ?? null,
    names: textIn(one, 'x-names'),
    each: isOfThings ? schemaOf(one) : null,
    isNeeded,
  };
}

/** What every request says: its kind, and its name. */
function isOfEvery(name: string, property: unknown): boolean {
  return name === 'request_id' || (name === 'kind' && textsIn(property, 'enum').length === 1);
}

/** What cannot be typed, as a recipe, is left out. */
export function schemaOf(document: unknown): Schema {
  const needed = textsIn(document, 'required');
  const properties = fieldsOf(fieldsOf(document)['properties']);
  const fields = Object.entries(properties).flatMap(([name, property]) =>
    isOfEvery(name, property) ? [] : (fieldOf(name, property, needed.includes(name)) ?? []),
  );
  const apart = listIn(document, 'allOf').flatMap((rule) => {
    const [one, other] = isFields(rule) ? textsIn(rule['not'], 'required') : [];
    return one !== undefined && other !== undefined ? [[one, other] as [string, string]] : [];
  });
  return {fields, apart};
}

export function wordsOf({fields}: Schema, name: string): string[] {
  return fields.find((field) => field.name === name)?.words ?? [];
}

const units: [ending: string, unit: string][] = [
  ['_mm', 'mm'], ['_deg', '°'], ['_percent', '%'], ['_px', 'px'], ['_us', 'µs'], ['_minutes', 'min'], ['_mb', 'MB'], ['_s', 's'],
];

/** "flatness_deg" is "Flatness", in degrees. */
export function labelOf({name}: Pick<SchemaField, 'name'>): {label: string; unit: string} {
  const [ending, unit] = units.find(([each]) => name.endsWith(each)) ?? ['', ''];
  const words = name.slice(0, name.length - ending.length).replaceAll('_', ' ');
  return {label: words.charAt(0).toUpperCase() + words.slice(1), unit};
}

/** "0.1 to 1000", "above 0", "at least 0". */
export function rangeInWords({least, isAbove, most}: SchemaField): string {
  if (least !== null && most !== null) return `${least} to ${most}`;
  if (least !== null) return isAbove ? `above ${least}` : `at least ${least}`;
  return most === null ? '' : `at most ${most}`;
}

function numberOf(text: string): number | null {
  return text.trim() !== '' && Number.isFinite(Number(text)) ? Number(text) : null;
}

function isWithin({holds, least, isAbove, most}: SchemaField, value: number): boolean {
  const isOver = least === null || value > least || (!isAbove && value === least);
  return isOver && (most === null || value <= most) && (holds !== 'whole' || Number.isInteger(value));
}

/** What was typed as the request says it; null: nothing. What is no number stays as it is, and the daemon says so. */
export function valueOf(field: SchemaField, text: string): FieldValue | null {
  if (text.trim() === '') return null;
  if (field.holds === 'number' || field.holds === 'whole') return numberOf(text) ?? text;
  const parts = text.split(',').map((part) => part.trim()).filter((part) => part !== '');
  if (field.holds === 'numbers') return parts.map((part) => numberOf(part) ?? part);
  return field.holds === 'words' ? parts : text.trim();
}

export function isWrong(field: SchemaField, value: FieldValue | undefined): boolean {
  if (value === undefined) return false;
  if (field.holds === 'number' || field.holds === 'whole') return typeof value !== 'number' || !isWithin(field, value);
  if (field.holds === 'numbers') return (value as unknown[]).some((each) => typeof each !== 'number' || !isWithin(field, each));
  return false;
}

/** The field that was said and keeps this one from being said; null: none. */
export function keptBy({apart}: Schema, name: string, said: readonly string[]): string | null {
  const others = apart.flatMap(([one, other]) => (one === name ? [other] : other === name ? [one] : []));
  return others.find((other) => said.includes(other)) ?? null;
}

/** The wish with one field said otherwise; null: not said. */
export function withValue(wish: Wish, name: string, value: FieldValue | null): Wish {
  const {[name]: before, ...others} = wish;
  return value === null ? others : {...others, [name]: value};
}
