// SPDX-License-Identifier: Apache-2.0
// .usda and .usdz: OpenUSD itself, built for pages, opens them; three's loader measures; unzip and the records of the
// zip judge the container, which both read too kindly.
import fs from 'node:fs';
import path from 'node:path';
import {byExitCode, python, run} from '../support/programs.mjs';
import {all, sameLength} from '../support/report.mjs';
import {entriesOf} from '../support/zip.mjs';

const head = '<script src="/node_modules/three-usdz-loader/external/emHdBindings.js"></script>';

/** A delegate that only notes what Hydra hands to it. */
const byOpenUsd = `
class Listener {
  meshes = []; nodes = []; connections = 0;
  createRPrim(type, id) {
    const mesh = {id, points: []};
    this.meshes.push(mesh);
    return new Proxy({}, {get: (_, call) => (values) => { if (call === 'updatePoints') mesh.points = Array.from(values); }});
  }
  createBPrim() { return new Proxy({}, {get: () => () => {}}); }
  createSPrim() {
    return new Proxy({}, {get: (_, call) => (...given) => {
      if (call === 'updateNode') this.nodes.push({path: given[1], inputs: Object.fromEntries(Object.entries(given[2] ?? {}).map(([key, value]) => [key, typeof value === 'object' ? Array.from(value) : value]))});
      if (call === 'updateFinished') this.connections += (given[1] ?? []).length;
    }});
  }
  CommitResources() {}
  setDriver() {}
}
async function work(addresses) {
  const usd = await getUsdModule(undefined, '/node_modules/three-usdz-loader/external');
  await usd.ready;
  const out = [];
  for (const [index, address] of addresses.entries()) {
    const name = 'file' + index + '.' + address.split('.').pop();
    usd.FS.createDataFile('/', name, new Uint8Array(await (await fetch(address)).arrayBuffer()), true, true, true);
    const listener = new Listener();
    try {
      new usd.HdWebSyncDriver(listener, name).Draw();
      const {meshes, nodes, connections} = listener;
      out.push({meshes, nodes, connections});
    } catch (error) {
      out.push({error: 'OpenUSD does not open it'});
    }
    console.log('end of ' + index);
  }
  return out;
}`;

const byThree = `
import * as THREE from 'three';
import {USDLoader} from 'three/addons/loaders/USDLoader.js';
async function work(addresses) {
  const out = [];
  for (const address of addresses) {
    try {
      const group = await new USDLoader().loadAsync(address);
      const size = new THREE.Box3().setFromObject(group).getSize(new THREE.Vector3());
      let material;
      group.traverse((part) => { material ??= part.material; });
      out.push({size_m: size.toArray(), map: material?.map?.colorSpace ?? null, normalMap: material?.normalMap?.colorSpace ?? null});
    } catch (error) {
      out.push({error: String(error?.message ?? error)});
    }
  }
  return out;
}`;

/** OpenUSD's words on each file: those of the console between two ends. */
function wordsOf(said, count) {
  const words = Array.from({length: count}, () => []);
  let at = 0;
  for (const line of said) {
    if (line === `end of ${at}`) at += 1;
    else if (/error/i.test(line) && at < count) words[at].push(line.trim());
  }
  return words.map((lines) => lines.find((line) => /Runtime Error/.test(line)) ?? '');
}

/** Every shader that the text defines must come out of Hydra, and every connection of one to another. */
export function countsOf(text) {
  const shaders = (text.match(/def Shader /g) ?? []).length;
  return {shaders, textures: (text.match(/"UsdUVTexture"/g) ?? []).length};
}

function judge(read, words, {nodes, size_mm}) {
  if (read.error || words) return {ok: false, says: words || read.error};
  const points = read.meshes[0]?.points ?? [];
  const verdicts = [
    {ok: read.meshes.length === 1, says: `${read.meshes.length} meshes`},
    {ok: read.nodes.length === nodes, says: `${read.nodes.length} shading nodes${read.nodes.length === nodes ? '' : ` of ${nodes}`}`},
  ];
  if (size_mm) {
    size_mm.forEach((mm, axis) => {
      const values = points.filter((_, at) => at % 3 === axis);
      verdicts.push(sameLength((Math.max(...values) - Math.min(...values)) * 1000, mm, 1e-6));
    });
  }
  for (const {path: where, inputs} of read.nodes) {
    if (!inputs.file) continue;
    const isColor = /base_?color|diffuse|albedo/i.test(`${where}`);
    const space = String(inputs.sourceColorSpace ?? '');
    verdicts.push({ok: isColor ? space === 'sRGB' : space === 'raw', says: `${where.split('/').pop()} is ${space}`});
  }
  return all(verdicts);
}

function judgeUnits(text) {
  return {ok: /metersPerUnit\s*=\s*1\s/.test(text) && /upAxis\s*=\s*"Y"/.test(text), says: 'metres, y up, for readers that ignore units'};
}

function judgeThree(read, size_mm) {
  if (read.error) return {ok: false, says: read.error};
  return all([
    ...size_mm.map((mm, axis) => sameLength(read.size_m[axis] * 1000, mm, 1e-6)),
    {ok: read.map === 'srgb', says: `albedo as "${read.map}"`}, {ok: read.normalMap === '', says: `normals as "${read.normalMap}"`},
  ]);
}

const twinsOf = {
  'broken syntax': (text) => text.replace(/\}\s*$/, ''),
  'a value of the wrong type': (text) => text.replace(/(float inputs:\w+) = [-\d.e]+/, '$1 = "text"'),
  'a connection to nobody': (text) => text.replace(/(inputs:diffuseColor\.connect = <[^>]*\/)\w+(\.outputs)/, '$1nobody$2'),
};

/** Stored, the layer first, each payload at a multiple of 64. */
export function judgeUsdz(bytes) {
  const entries = entriesOf(bytes);
  return all([
    {ok: /\.usd[ac]?$/.test(entries[0]?.name ?? ''), says: `${entries[0]?.name} first`},
    {ok: entries.every(({method}) => method === 0), says: 'stored'},
    ...entries.map(({name, payload}) => ({ok: payload % 64 === 0, says: payload % 64 === 0 ? `${entries.length} payloads at multiples of 64` : `${name} begins at ${payload}, ${payload % 64} past a multiple of 64`})),
  ]);
}

/** The same entries as Python's zipfile stores them: a good zip, and no usdz. */
function rezipped(file, twin, method) {
  const script = 'import sys, zipfile\nold = zipfile.ZipFile(sys.argv[1])\n' +
    'new = zipfile.ZipFile(sys.argv[2], "w", int(sys.argv[3]))\n[new.writestr(n, old.read(n)) for n in old.namelist()]\nnew.close()';
  const {code, err} = run(python, ['-c', script, file, twin, String(method)]);
  if (code !== 0) throw new Error(err);
}

function checkContainer({report, file, scratch}) {
  const name = path.basename(file);
  const bytes = fs.readFileSync(file);
  report.check(`${name} its records`, judgeUsdz(bytes));
  for (const [what, method] of [['stored by Python', 0], ['deflated by Python', 8]]) {
    const twin = path.join(scratch, `${what.replaceAll(' ', '_')}_${name}`);
    rezipped(file, twin, method);
    report.refuses(`${name} ${what}`, judgeUsdz(fs.readFileSync(twin)));
  }
  report.check(`${name} by unzip`, byExitCode('unzip', ['-tq', file]));
  const bad = Buffer.from(bytes);
  bad[entriesOf(bytes)[0].payload + 20] ^= 1;
  const twin = path.join(scratch, `flipped_bit_${name}`);
  fs.writeFileSync(twin, bad);
  report.refuses(`${name} with a flipped bit, by unzip`, byExitCode('unzip', ['-tq', twin]));
}

function textOf(file) {
  return path.extname(file) === '.usdz' ? entriesOf(fs.readFileSync(file))[0].bytes.toString() : fs.readFileSync(file, 'utf8');
}

export async function check({report, files, size_mm, scratch, browser}) {
  for (const file of files) {
    report.check(`${path.basename(file)} its units`, judgeUnits(textOf(file)));
    if (path.extname(file) === '.usdz') checkContainer({report, file, scratch});
  }
  report.refuses('a layer in centimetres', judgeUnits(textOf(files[0]).replace(/metersPerUnit\s*=\s*1/, 'metersPerUnit = 0.01')));
  if (!browser) return;
  const layers = files.filter((file) => path.extname(file) === '.usda');
  const twins = layers.flatMap((file) => Object.entries(twinsOf).map(([what, broken]) => {
    const twin = path.join(scratch, `${what.replaceAll(' ', '_')}_${path.basename(file)}`);
    const bad = broken(textOf(file));
    fs.writeFileSync(twin, bad);
    return {file, what, twin, differs: bad !== textOf(file)};
  }));
  const tasks = [...files, ...twins.map(({twin}) => twin)];
  const {result, said} = await browser.run(byOpenUsd, tasks.map((file) => browser.address(file)), {head});
  const words = wordsOf(said, tasks.length);
  files.forEach((file, at) => report.check(`${path.basename(file)} by OpenUSD`, judge(result[at], words[at], {nodes: nodesOf(textOf(file)), size_mm})));
  twins.forEach(({file, what, differs}, index) => {
    const at = files.length + index;
    if (!differs) report.check(`${path.basename(file)} with ${what}`, {ok: false, says: 'the twin could not be made'});
    else report.refuses(`${path.basename(file)} with ${what}, by OpenUSD`, judge(result[at], words[at], {nodes: nodesOf(textOf(file)), size_mm}));
  });
  if (size_mm) await checkThree({report, files, size_mm, scratch, browser});
}

/** Shaders that something uses; those of MaterialX beside them are not OpenUSD's to read here. */
function nodesOf(text) {
  return countsOf(text).shaders;
}

async function checkThree({report, files, size_mm, scratch, browser}) {
  const {result} = await browser.run(byThree, files.map((file) => browser.address(file)));
  files.forEach((file, at) => {
    report.check(`${path.basename(file)} by three's USDLoader`, judgeThree(result[at], size_mm));
    report.refuses(`${path.basename(file)} for a cloth a hundred thousandth larger, by three's USDLoader`, judgeThree(result[at], size_mm.map((mm) => mm * 1.00001)));
  });
}
