// SPDX-License-Identifier: Apache-2.0
// What presets hold and lose, by export.json and by what a price found, in the words of the panel.
import type {Schemas} from '../../api/client';
import {fieldsOf, listIn, numberIn, textIn} from '../../ui/fields';
import {digits} from '../../ui/say';
import {bytesOf} from '../../ui/words';
import {addressOfMaterial, type MaterialName} from './material_sight';

export interface ExportFile {
  file: string;
  bytes: number | null;
  /** "png, 8 bits, green down, loses 0.18°" */
  says: string;
}

const directions: Record<string, string> = {opengl: 'green up', directx: 'green down'};

/** Degrees of normals and share of the albedo, the mean of each. */
function lossInWords(lost: unknown): string[] {
  const deg = numberIn(fieldsOf(lost)['normal_deg'], 'mean');
  const albedo = numberIn(fieldsOf(lost)['albedo'], 'mean');
  return [
    ...(deg === null ? [] : [`normals lose ${digits(deg, 2)}°`]),
    ...(albedo === null ? [] : [`albedo ${digits(albedo, 2)}`]),
  ];
}

function fileOf(entry: unknown): ExportFile {
  const direction = directions[textIn(entry, 'direction')];
  const words = [textIn(entry, 'encoding') || textIn(entry, 'kind'), ...(direction ? [direction] : []), ...lossInWords(fieldsOf(entry)['lost'])];
  return {file: textIn(entry, 'file'), bytes: numberIn(entry, 'bytes'), says: words.filter((word) => word !== '').join(', ')};
}

/** The files of an export.json: textures first, then documents. */
export function filesOf(document: unknown): ExportFile[] {
  return [...listIn(document, 'files'), ...listIn(document, 'documents')].map(fileOf);
}

export interface ExportPrice {
  bytes: number;
  seconds: number;
  files: ExportFile[];
}

/** By preset, what `weft export --explain` said of it; '' stands for what normals and albedo cost in every format. */
export function pricesOf(result: unknown): Map<string, ExportPrice> {
  const prices = new Map<string, ExportPrice>();
  for (const row of listIn(result, 'rows')) {
    const preset = textIn(row, 'preset');
    const price = prices.get(preset) ?? {bytes: 0, seconds: 0, files: []};
    prices.set(preset, {
      bytes: price.bytes + (numberIn(row, 'bytes') ?? 0),
      seconds: price.seconds + (numberIn(row, 'seconds') ?? 0),
      files: [...price.files, fileOf(row)],
    });
  }
  return prices;
}

export function priceInWords({bytes, seconds}: ExportPrice): string {
  return `${bytesOf(bytes)}, ${digits(seconds, 2)} s`;
}

/** Where exports of it are listed. */
export function addressOfExports(name: MaterialName): string {
  return name.is === 'maps' ? `/api/v1/sessions/${encodeURIComponent(name.of)}/exports` : `${addressOfMaterial(name)}/exports`;
}

/** Folders of a name stand as ":" in a call. */
export function addressOfFile(name: MaterialName, preset: string, file: string): string {
  return `${addressOfExports(name)}/${encodeURIComponent(preset)}/files/${encodeURIComponent(file.replaceAll('/', ':'))}`;
}

/** What a job is asked for. */
export function requestOf(kind: 'export' | 'export_price', {of, is, id}: MaterialName, presets: string[], draft = false): Schemas['ExportJob'] | Schemas['ExportPriceJob'] {
  return {kind, ...(is === 'maps' ? {session: of} : {material: of}), set: id, presets, ...(draft && {draft})};
}
