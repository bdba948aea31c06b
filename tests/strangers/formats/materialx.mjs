// SPDX-License-Identifier: Apache-2.0
// .mtlx: MaterialX in node validates and makes shaders; three's loader in Chromium finds the surface.
import fs from 'node:fs';
import path from 'node:path';
import {here, run} from '../support/programs.mjs';
import {all, sameLength} from '../support/report.mjs';

function byMaterialX(files) {
  const {code, out, err} = run(process.execPath, [path.join(here, 'support/materialx.cjs'), ...files]);
  const lines = out.trim().split('\n');
  if (code !== 0 || lines.length !== files.length) throw new Error(`MaterialX: exit code ${code}, ${err}`);
  return lines.map((line) => JSON.parse(line));
}

function judge({ok, says, nodes, shaders = []}) {
  if (!ok) return {ok, says: says.trim().split('\n')[0]};
  const made = shaders.length > 0 && shaders.every((length) => length > 1000);
  return {ok: made, says: made ? `valid, ${nodes} nodes, ${shaders.length} shaders of ${shaders.join(', ')} bytes of GLSL` : 'no shader was made'};
}

const mm_by_unit = {meter: 1000, centimeter: 10, millimeter: 1};

/** realworldimagesize of every image that has one. */
function judgeSize({images = []}, size_mm) {
  const sized = images.filter(({imageSize}) => imageSize);
  return all(sized.flatMap(({imageSize, unit}) => imageSize.split(',').map((text, axis) => sameLength(Number(text) * (mm_by_unit[unit] ?? NaN), size_mm[axis], 1e-6))).slice(0, 2 * sized.length));
}

/** Colours are sRGB, data are nothing, and the files are there. */
function judgeImages({images = []}, folder) {
  return all(images.map(({name, file, colorspace}) => {
    const there = fs.existsSync(path.join(folder, file));
    return {ok: there && ['', 'srgb_texture', 'lin_rec709'].includes(colorspace), says: `${name}${colorspace ? ` ${colorspace}` : ''}${there ? '' : `: ${file} is not there`}`};
  }));
}

const twinsOf = {
  'a wrong type': (text) => text.replace(/(<input name="(?:base_color|specular_roughness|roughness)" type=")(\w+)"/, (_, head, type) => `${head}${type === 'float' ? 'color3' : 'float'}"`),
  'an unknown input': (text) => text.replace(/<input name="(base_color|specular_roughness|roughness)"/, '<input name="$1_of_nobody"'),
  'a dangling node': (text) => text.replace(/nodename="\w+"/, 'nodename="nobody"'),
  'broken XML': (text) => text.replace(/<\/materialx>\s*$/, '</material'),
};

const byThree = `
import 'three/webgpu';
import {MaterialXLoader} from 'three/addons/loaders/MaterialXLoader.js';
async function work(addresses) {
  const out = [];
  for (const address of addresses) {
    try {
      const {materials} = await new Promise((done, fail) => new MaterialXLoader().load(address, done, undefined, fail));
      out.push(Object.values(materials).map((material) => ({name: material.name, color: !!material.colorNode, roughness: !!material.roughnessNode, normal: !!material.normalNode})));
    } catch (error) {
      out.push({error: String(error?.message ?? error)});
    }
  }
  return out;
}`;

function judgeThree(read) {
  if (read.error) return {ok: false, says: read.error};
  const found = read.find(({color, roughness, normal}) => color && roughness && normal);
  return {ok: !!found, says: found ? `${found.name}: colour, roughness and normal are nodes` : 'a grey material'};
}

export async function check({report, files, size_mm, scratch, browser}) {
  const twins = files.flatMap((file) => Object.entries(twinsOf).map(([what, broken]) => {
    const text = fs.readFileSync(file, 'utf8');
    const twin = path.join(scratch, `${path.basename(file, '.mtlx')}_${what.replaceAll(' ', '_')}.mtlx`);
    const bad = broken(text);
    fs.writeFileSync(twin, bad);
    return {file, what, twin, differs: bad !== text};
  }));
  const read = byMaterialX([...files, ...twins.map(({twin}) => twin)]);
  files.forEach((file, at) => {
    const name = path.basename(file);
    report.check(`${name} by MaterialX`, judge(read[at]));
    if (read[at].images?.length) report.check(`${name} its images`, judgeImages(read[at], path.dirname(file)));
    if (size_mm && read[at].images?.length) {
      report.check(`${name} size by MaterialX`, judgeSize(read[at], size_mm));
      report.refuses(`${name} size for a cloth a hundred thousandth larger`, judgeSize(read[at], size_mm.map((mm) => mm * 1.00001)));
    }
  });
  twins.forEach(({file, what, differs}, at) => {
    if (!differs) report.check(`${path.basename(file)} with ${what}`, {ok: false, says: 'the twin could not be made'});
    else report.refuses(`${path.basename(file)} with ${what}, by MaterialX`, judge(read[files.length + at]));
  });
  // What three's loader knows: textures on one surface, and no mix of two.
  const forThree = files.filter((_, at) => read[at].images?.length && !/<mix [^>]*type="surfaceshader"/.test(fs.readFileSync(files[at], 'utf8')));
  if (browser && forThree.length) await checkThree({report, files: forThree, browser, scratch});
}

async function checkThree({report, files, browser, scratch}) {
  const twins = files.map((file) => {
    const twin = path.join(scratch, `grey_${path.basename(file)}`);
    fs.writeFileSync(twin, fs.readFileSync(file, 'utf8').replace(/standard_surface|open_pbr_surface|gltf_pbr/g, 'surface_of_nobody'));
    return twin;
  });
  const {result} = await browser.run(byThree, [...files, ...twins].map((file) => browser.address(file)));
  files.forEach((file, at) => {
    report.check(`${path.basename(file)} by three's MaterialXLoader`, judgeThree(result[at]));
    report.refuses(`${path.basename(file)} with a surface of nobody, by three's MaterialXLoader`, judgeThree(result[files.length + at]));
  });
}
