// SPDX-License-Identifier: Apache-2.0
// What lies in a folder of exports: a folder a preset, each with an export.json that says what its files hold.
import fs from 'node:fs';
import path from 'node:path';

const encodings = {'.png': 'png', '.tif': 'tiff', '.tiff': 'tiff', '.exr': 'exr', '.dds': 'dds', '.tx': 'tx'};

function entryOf(folder, preset, document, file) {
  const channels = file.channels ?? [];
  return {
    file: path.join(folder, file.file), preset, title: `${preset}/${file.file}`, sha256: file.sha256,
    encoding: encodings[path.extname(file.file)] ?? path.extname(file.file).slice(1), blocks: file.blocks,
    bits: file.bits, channels: channels.map((channel) => channel.name ?? channel),
    ranges: channels.map(({least, most}) => (typeof least === 'number' ? [least, most] : null)),
    color: file.color ?? 'data', direction: file.normal ?? document.normal ?? 'opengl', roughness: document.roughness ?? 'root',
  };
}

/** {entries, documents}: images with what they hold, and documents by their extension. */
export function exportsOf(root) {
  const entries = [];
  const documents = {};
  for (const name of fs.readdirSync(root).sort()) {
    const folder = path.join(root, name);
    const said = path.join(folder, 'export.json');
    if (!fs.existsSync(said)) continue;
    const document = JSON.parse(fs.readFileSync(said, 'utf8'));
    for (const file of document.files) {
      const entry = entryOf(folder, document.preset?.name ?? document.preset ?? name, document, file);
      const extension = path.extname(file.file).slice(1);
      if (extension in {glb: 1, mtlx: 1, usda: 1, usdz: 1, u3m: 1, u3ma: 1}) (documents[extension] ??= []).push(entry.file);
      else if (entry.channels.length) entries.push(entry);
    }
  }
  return {entries, documents};
}

/** The first of entries that hold the same bytes with the same meaning. */
export function different(entries) {
  const seen = new Set();
  return entries.filter((entry) => {
    const key = JSON.stringify([entry.sha256, entry.channels, entry.ranges, entry.color, entry.direction, entry.roughness]);
    return entry.sha256 ? !seen.has(key) && seen.add(key) : true;
  });
}
