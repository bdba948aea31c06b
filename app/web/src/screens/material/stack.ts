// SPDX-License-Identifier: Apache-2.0
// The stack of a material as its files say it: layers from the bottom to the top, each value with the file it is from.
import type {Schemas} from '../../api/client';
import {isFields, listIn, textIn} from '../../ui/fields';

type Resolved = Schemas['ResolvedMaterial'];
export type MaterialValue = Schemas['MaterialValue'];

export interface StackLayer {
  name: string;
  material: string;
  alpha: number;
  mask: string;
  /** "replace" or "detail". */
  blend: string;
  /** The files that say something of it, the last part of their names. */
  from: string[];
  values: MaterialValue[];
}

/** A number, a word, or what a mask or map is made of: "cavity, radius 0.4 mm". */
export function valueInWords(value: unknown): string {
  if (Array.isArray(value)) return value.map(valueInWords).join(' ');
  if (typeof value === 'number') return String(Number(value.toPrecision(4)));
  if (!isFields(value)) return String(value);
  const parts = Object.entries(value).map(([key, each]) => {
    if (key === 'value') return valueInWords(each);
    if (key === 'map' || key === 'scan') return `${key} ${fileName(valueInWords(each))}`;
    if (key === 'from' || key === 'kind') return valueInWords(each);
    const unit = key.match(/_(mm|deg)$/)?.[1];
    return `${key.replace(/_(mm|deg)$/, '').replaceAll('_', ' ')} ${valueInWords(each)}${unit === 'mm' ? ' mm' : unit ? '°' : ''}`;
  });
  return parts.join(', ');
}

export function fileName(file: string): string {
  return file.startsWith('library:') ? file : (file.split('/').pop() ?? file);
}

function numberIn(value: unknown): number | null {
  if (typeof value === 'number') return value;
  return Array.isArray(value) && typeof value[0] === 'number' ? value[0] : null;
}

/** Top first, as it is looked at. */
export function stackOf(resolved: Pick<Resolved, 'layers' | 'values'>): StackLayer[] {
  return [...resolved.layers].reverse().map((name) => {
    const prefix = `layer.${name}.`;
    const values = resolved.values.filter(({key}) => key.startsWith(prefix)).map((each) => ({...each, key: each.key.slice(prefix.length)}));
    const of = (key: string) => values.find((each) => each.key === key)?.value;
    const material = of('material');
    return {
      name,
      material: fileName(typeof material === 'string' ? material : valueInWords(material ?? '')),
      alpha: numberIn(of('alpha')) ?? 1,
      mask: of('mask') === undefined ? 'everywhere' : valueInWords(of('mask')),
      blend: typeof of('blend') === 'string' ? String(of('blend')) : 'replace',
      from: [...new Set(values.map(({from}) => fileName(from)))],
      values,
    };
  });
}

/** A layer as it is wished. */
export interface LayerWish {
  name: string;
  alpha: number;
  isOn: boolean;
}

/** Top first. */
export function wishesOf(stack: readonly StackLayer[]): LayerWish[] {
  return stack.map(({name, alpha}) => ({name, alpha, isOn: alpha > 0}));
}

/** With the layer at `index` one place higher (-1) or lower (1). */
export function movedBy(wishes: readonly LayerWish[], index: number, by: -1 | 1): LayerWish[] {
  const moved = [...wishes];
  const [layer] = moved.splice(index, 1);
  if (layer) moved.splice(Math.min(Math.max(index + by, 0), moved.length), 0, layer);
  return moved;
}

/** What is asked of the daemon: from the bottom to the top, with the alphas that changed. A layer that is off has none. */
export function requestOf(name: string, inherits: string, wishes: readonly LayerWish[], stack: readonly StackLayer[]): Schemas['NewMaterial'] {
  const layers = [...wishes].reverse().map((wish) => {
    const alpha = wish.isOn ? wish.alpha : 0;
    const before = stack.find((layer) => layer.name === wish.name)?.alpha;
    return {name: wish.name, ...(alpha === before ? {} : {alpha})};
  });
  return {name, inherits, layers};
}

/** What is not of a layer: the material's own values. */
export function ownValues({values}: Pick<Resolved, 'values'>): MaterialValue[] {
  return values.filter(({key}) => !key.startsWith('layer.'));
}

/** The id of what a job of the kind material built. */
export function builtBy(result: unknown): string {
  return textIn(listIn(result, 'materials')[0], 'id');
}
