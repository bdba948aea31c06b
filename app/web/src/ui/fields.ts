// SPDX-License-Identifier: Apache-2.0
// Fields of documents whose content the interface's description leaves open.

export type Fields = {readonly [key: string]: unknown};

export function isFields(value: unknown): value is Fields {
  return typeof value === 'object' && value !== null && !Array.isArray(value);
}

export function fieldsOf(value: unknown): Fields {
  return isFields(value) ? value : {};
}

export function numberIn(document: unknown, key: string): number | null {
  const value = fieldsOf(document)[key];
  return typeof value === 'number' ? value : null;
}

export function textIn(document: unknown, key: string): string {
  const value = fieldsOf(document)[key];
  return typeof value === 'string' ? value : '';
}

export function listIn(document: unknown, key: string): unknown[] {
  const value = fieldsOf(document)[key];
  return Array.isArray(value) ? value : [];
}

export function textsIn(document: unknown, key: string): string[] {
  return listIn(document, key).filter((value) => typeof value === 'string');
}
