// SPDX-License-Identifier: Apache-2.0
// What lies in a folder of exports: a folder a preset, each with an export.json that says what its files hold.
import fs from 'node:fs';
import path from 'node:path';

/** "png, 16 bits", "exr, half", "dds, bc5": encoding, bits a channel, blocks. */
function storedOf(words) {
  const [encoding, how] = words.split(', ');
  const bits = {half: 16, float: 32}[how] ?? Number(/^\d+/.exec(how)?.[0] ?? 8);
  return {encoding, bits, blocks: encoding === 'dds' ? how : undefined};
}

function entryOf(folder, preset, document, file) {
  return {
    ...storedOf(file.encoding), file: path.join(folder, file.file), preset, title: `${preset}/${file.file}`, sha256: file.sha256,
    channels: file.channels.map(({name}) => name), ranges: file.channels.map(({at_0, at_1}) => (typeof at_0 === 'number' ? [at_0, at_1] : null)),
    color: file.color, direction: file.direction ?? 'opengl', roughness: file.roughness ?? document.roughness, lost: file.lost,
    means: file.channels.map(({lost}) => lost.mean),
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
    // Files that a document took into itself lie nowhere else.
    const there = document.files.filter(({file}) => fs.existsSync(path.join(folder, file)));
    entries.push(...there.map((file) => entryOf(folder, document.preset, document, file)));
    for (const {kind, file} of document.documents) (documents[kind] ??= []).push(path.join(folder, file));
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

/** The folder of maps that exports were made of: `folder` itself, or the one in it that is named by their id. */
export function mapsOf(root, folder) {
  if (['maps.json', 'material.json'].some((name) => fs.existsSync(path.join(folder, name)))) return folder;
  for (const name of fs.readdirSync(root)) {
    const said = path.join(root, name, 'export.json');
    if (!fs.existsSync(said)) continue;
    const {from} = JSON.parse(fs.readFileSync(said, 'utf8'));
    return path.join(folder, from.material ?? from.maps);
  }
  return folder;
}
