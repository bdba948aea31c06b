// SPDX-License-Identifier: Apache-2.0
// Programs that nobody here wrote read what weft exports: a line a check with its number, and each check on a broken
// twin that it must refuse. What is missing on a machine is skipped with the reason. Exit code 1 where a check failed.
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import {parseArgs} from 'node:util';
import {Browser, whyNoBrowser} from './support/browser.mjs';
import {Maps} from './support/catalogue.mjs';
import {different, exportsOf, mapsOf} from './support/exports.mjs';
import {has, hasModule, python} from './support/programs.mjs';
import {Report} from './support/report.mjs';

const help = `node run.mjs EXPORTS --maps FOLDER -o FOLDER [--only GROUP,...] [--blender] [--strict]
  EXPORTS    a folder of exports, a preset each
  --maps     the maps that were exported, or the folder where they lie under their id
  -o         for checks.txt with a line a check, and the pictures of Blender
  --quiet    failures, what was skipped, and sums
  --only     origin, images, tx, dds, glb, mtlx, usd, u3m, blender
  --blender  Blender too, which takes a quarter of a minute
  --strict   what is skipped is a failure
`;

function argumentsOf() {
  const {values, positionals} = parseArgs({allowPositionals: true, options: {
    maps: {type: 'string'}, output: {type: 'string', short: 'o'}, only: {type: 'string'}, blender: {type: 'boolean'}, quiet: {type: 'boolean'}, strict: {type: 'boolean'},
  }});
  if (positionals.length !== 1 || !values.maps || !values.output) {
    process.stderr.write(help);
    process.exit(64);
  }
  return {...values, root: positionals[0], only: values.only?.split(',')};
}

/** Normals and albedo as pictures, for judges of whole files. */
function truthOf(folder) {
  const truth = new Maps(folder);
  truth.albedo = truth.pixelsOf('albedo', ['R', 'G', 'B']);
  truth.normal = truth.pixelsOf('normal', ['X', 'Y', 'Z']);
  if (!truth.albedo || !truth.normal) throw new Error(`${folder} has no albedo.exr with R, G, B and no normal.exr with X, Y, Z of its size`);
  return truth;
}

function missing() {
  const skips = {};
  if (!has(python) || !hasModule('numpy')) throw new Error(`${python} with numpy (Debian's python3-numpy) carries texels from readers to here`);
  if (!hasModule('OpenImageIO')) throw new Error(`${python} reads the maps by OpenImageIO (Debian's python3-openimageio)`);
  if (!hasModule('PIL')) skips.pillow = 'there is no Pillow (Debian\'s python3-pil)';
  return skips;
}

function imagesForBlender(entries) {
  const mine = entries.filter(({preset}) => preset === 'blender');
  const holding = (channel) => mine.find(({channels}) => channels[0] === channel)?.file;
  const [diffuse, normal, rough] = ['albedo.r', 'normal.x', 'roughness'].map(holding);
  return diffuse && normal ? {diffuse, normal, rough, all: mine.map(({file}) => file)} : null;
}

async function main() {
  const {root, maps, output, only, blender, quiet, strict} = argumentsOf();
  fs.mkdirSync(output, {recursive: true});
  const log = path.join(output, 'checks.txt');
  fs.writeFileSync(log, '');
  const show = (line) => process.stdout.write(`${line}\n`);
  const report = new Report({
    print: (line) => {
      fs.appendFileSync(log, `${line}\n`);
      if (!quiet) show(line);
    },
    loud: quiet ? show : () => {},
  });
  const skips = missing();
  const truth = truthOf(mapsOf(root, maps));
  const {entries, documents} = exportsOf(root);
  const scratch = fs.mkdtempSync(path.join(os.tmpdir(), 'weft-strangers-'));
  const browser = whyNoBrowser ? null : await Browser.open();
  const common = {report, truth, size_mm: truth.size_mm, scratch, browser, skips, folder: output, entries: different(entries)};
  const group = async (name, module, more) => {
    if (only && !only.includes(name)) return;
    const empty = Object.values(more).every((files) => Array.isArray(files) && files.length === 0);
    if (empty) report.check(name, {ok: false, says: 'nothing of this kind was exported'});
    else await report.group(name, async () => (await import(module)).check({...common, ...more}));
  };
  if (!browser) report.skip('MaterialX, USD and glTF in Chromium, and blocks', whyNoBrowser);
  const ofKind = (...kinds) => common.entries.filter(({encoding}) => kinds.includes(encoding));
  const named = (...kinds) => kinds.flatMap((kind) => documents[kind] ?? []);
  await group('origin', './formats/origin.mjs', {root});
  await group('images', './formats/images.mjs', {entries: ofKind('png', 'tiff', 'exr')});
  await group('tx', './formats/tx.mjs', {entries: ofKind('tx')});
  const blocks = ofKind('dds');
  await group('dds', './formats/dds.mjs', {files: blocks.map(({file}) => file), entryOf: (file) => blocks.find((entry) => entry.file === file)});
  await group('glb', './formats/gltf.mjs', {files: named('glb')});
  await group('mtlx', './formats/materialx.mjs', {files: named('mtlx')});
  await group('usd', './formats/usd.mjs', {files: named('usda', 'usdz')});
  await group('u3m', './formats/u3m.mjs', {files: named('u3m', 'u3ma')});
  const {whyNoBlender} = await import('./formats/blender.mjs');
  if (!blender) {
    if (!only) report.skip('Blender', 'it was not asked for: --blender');
  } else if (whyNoBlender) report.skip('Blender', whyNoBlender);
  else await group('blender', './formats/blender.mjs', {glbs: named('glb'), images: imagesForBlender(entries)});
  await browser?.close();
  fs.rmSync(scratch, {recursive: true});
  if (strict && report.skipped) report.check('what was skipped', {ok: false, says: `${report.skipped} of all that is needed is not on this machine`});
  process.exit(report.end());
}

await main();
