// SPDX-License-Identifier: Apache-2.0
// Blender, headless: albedo, direction of normals and size as numbers, from .glb and from images; a picture of each for
// people, who find them in the folder of results.
import fs from 'node:fs';
import path from 'node:path';
import {angles, difference, linearOfSrgb, normalsOf} from '../support/compare.mjs';
import {imageOfTexture, plain, putTogether, takeApart, withImage} from '../support/glb.mjs';
import {greenFlipped, readPixels, readPng, readPngFile, writePng} from '../support/pixels.mjs';
import {has, here, run} from '../support/programs.mjs';
import {all, below, sameLength} from '../support/report.mjs';

export const whyNoBlender = has('blender') ? '' : 'there is no blender (Debian\'s blender, 270 MB)';

function render(tasks, scratch) {
  const list = path.join(scratch, 'blender.json');
  fs.writeFileSync(list, JSON.stringify(tasks));
  const {out, err} = run('blender', ['-b', '--factory-startup', '-noaudio', '--python', path.join(here, 'blender/read.py'), '--', list], {seconds: 300});
  const lines = out.split('\n').filter((line) => line.startsWith('WEFT ')).map((line) => JSON.parse(line.slice(5)));
  if (lines.length !== tasks.length) throw new Error(`Blender ended early: ${err.slice(-2000) || out.slice(-2000)}`);
  return lines;
}

/** Passes of Blender: x to the right, z up and -y to the camera become x, y, z of the cloth. */
function passesOf(file) {
  const [read] = readPixels('openimageio', [file]);
  if (read.error) throw new Error(`${file}: ${read.error}`);
  const channel = (end) => read.names.findIndex((name) => name.endsWith(end));
  const pick = (channels, signs = [1, 1, 1]) => {
    const data = new Float32Array(read.width * read.height * 3);
    for (let texel = 0; texel < read.width * read.height; texel += 1) {
      channels.forEach((from, at) => { data[3 * texel + at] = signs[at] * read.data[texel * read.channels + from]; });
    }
    return {width: read.width, height: read.height, channels: 3, bits: 32, whole: false, data};
  };
  return {
    albedo: pick(['DiffCol.R', 'DiffCol.G', 'DiffCol.B'].map(channel)),
    normal: pick(['.Normal.X', '.Normal.Z', '.Normal.Y'].map(channel), [1, 1, -1]),
  };
}

function judgeAlbedo(seen, own) {
  return below(difference(seen, own, [[0, 0], [1, 1], [2, 2]], {ofTruth: linearOfSrgb}).most, 0.002, '', ' at most in linear light');
}

function judgeNormals(seen, own, limit, against) {
  const {mean, most} = angles(normalsOf(seen, {stored: true}), own);
  return below(mean, limit, ' deg', ` in the mean from ${against}, most ${most.toFixed(2)}, tilt below 40 deg`);
}

/** How the picture's light over its albedo goes with the cosine to the lamp, which stands up, left and in front. */
function judgeRelief(picture, own, normals) {
  const toLamp = [-1, 1, 1].map((value) => value / Math.sqrt(3));
  const light = ({data, channels}, texel) => [0.2126, 0.7152, 0.0722].reduce((sum, weight, at) => sum + weight * linearOfSrgb(data[channels * texel + at]), 0);
  let [n, sx, sy, sxx, syy, sxy] = [0, 0, 0, 0, 0, 0];
  for (let texel = 0; texel < picture.width * picture.height; texel += 1) {
    const cosine = Math.max(0, toLamp.reduce((sum, value, at) => sum + value * normals.data[3 * texel + at], 0));
    const shade = light(picture, texel) / Math.max(0.01, light(own.albedo, texel));
    n += 1;
    sx += cosine;
    sy += shade;
    sxx += cosine * cosine;
    syy += shade * shade;
    sxy += cosine * shade;
  }
  const correlation = (n * sxy - sx * sy) / Math.sqrt((n * sxx - sx * sx) * (n * syy - sy * sy));
  return {ok: correlation > 0.8, says: `its light goes with the cosine to the lamp by ${correlation.toFixed(3)} (at least 0.8)`};
}

/** Colour spaces that Blender gives the images of a .glb, by their names: colours sRGB, all else none. */
function judgeSpaces(spaces, {json}) {
  const [{pbrMetallicRoughness: metal, extensions: more = {}}] = json.materials;
  const colors = [metal.baseColorTexture, more.KHR_materials_sheen?.sheenColorTexture, more.KHR_materials_specular?.specularColorTexture];
  const names = colors.filter(Boolean).map(({index}) => json.images[json.textures[index].source].name);
  return all(json.images.filter(({name}) => spaces[name]).map(({name}) => {
    const wanted = names.includes(name) ? 'sRGB' : 'Non-Color';
    return {ok: spaces[name] === wanted, says: `${name} is ${spaces[name]}`};
  }));
}

/** The tasks of one .glb: without its extensions for passes, since sheen is mixed into them; flipped; larger. */
function tasksOfGlb(file, truth, folder, scratch) {
  const name = path.basename(file, '.glb');
  const parts = takeApart(fs.readFileSync(file));
  const material = parts.json.materials[0];
  const own = {albedo: readPng(imageOfTexture(parts, material.pbrMetallicRoughness.baseColorTexture.index)), normal: readPng(imageOfTexture(parts, material.normalTexture.index))};
  const even = path.join(scratch, `${name}_plain.glb`);
  fs.writeFileSync(even, putTogether(plain(parts)));
  const flipped = path.join(scratch, `${name}_flipped.glb`);
  fs.writeFileSync(flipped, putTogether(plain(withImage(parts, material.normalTexture.index, writePng(greenFlipped(own.normal))))));
  const size = {width: truth.width, height: truth.height};
  const task = (from, shows, out) => ({kind: 'glb', file: from, shows, out, ...size});
  return {
    title: `${path.basename(file)}`, own, parts,
    tasks: [task(even, 'passes', path.join(scratch, `${name}_passes.exr`)), task(flipped, 'passes', path.join(scratch, `${name}_flipped.exr`)), task(file, 'picture', path.join(folder, `${name}_glb.png`))],
  };
}

function tasksOfImages({diffuse, normal, rough}, truth, folder, scratch) {
  const own = {albedo: readPngFile(diffuse), normal: readPngFile(normal)};
  const flipped = path.join(scratch, `flipped_${path.basename(normal)}`);
  fs.writeFileSync(flipped, writePng(greenFlipped(own.normal)));
  const common = {kind: 'images', diffuse, rough, width: truth.width, height: truth.height};
  return {
    title: path.basename(diffuse), own,
    tasks: [
      {...common, normal, shows: 'passes', out: path.join(scratch, 'images_passes.exr')},
      {...common, normal: flipped, shows: 'passes', out: path.join(scratch, 'images_flipped.exr')},
      {...common, normal, shows: 'picture', out: path.join(folder, 'images.png')},
    ],
  };
}

function checkOne({report, set, read, truth}) {
  const [good, flipped, shown] = read;
  const {title, own} = set;
  for (const {error} of read) if (error) return report.check(`${title} by Blender`, {ok: false, says: error});
  const seen = passesOf(set.tasks[0].out);
  const twin = passesOf(set.tasks[1].out);
  const mine = normalsOf(own.normal);
  report.check(`${title} albedo by Blender`, judgeAlbedo(seen.albedo, own.albedo));
  const brighter = {...seen.albedo, data: seen.albedo.data.map((value) => value + 0.0035)};
  report.refuses(`${title} albedo 0.0035 brighter, by Blender`, judgeAlbedo(brighter, own.albedo));
  report.check(`${title} normals by Blender`, judgeNormals(seen.normal, mine, 0.05, 'the file'));
  if (truth.normal) report.check(`${title} normals by Blender`, judgeNormals(seen.normal, truth.normal, own.normal.bits === 16 ? 0.01 : 0.2, 'the maps'));
  report.refuses(`${title} with green flipped, by Blender`, judgeNormals(twin.normal, mine, 0.05, 'the file'));
  if (truth.size_mm) {
    truth.size_mm.forEach((mm, axis) => {
      report.check(`${title} ${['width', 'height'][axis]} by Blender`, sameLength(good.size_m[axis] * 1000, mm, set.sizeLimit ?? 1e-6));
      report.refuses(`${title} ${['width', 'height'][axis]} a ten thousandth larger, by Blender`, sameLength(good.size_m[axis] * 1000, mm * 1.0001, set.sizeLimit ?? 1e-6));
    });
  }
  if (set.parts) {
    report.check(`${title} colour spaces by Blender`, judgeSpaces(shown.spaces, set.parts));
    const exchanged = Object.fromEntries(Object.entries(shown.spaces).map(([image, space]) => [image, space === 'sRGB' ? 'Non-Color' : 'sRGB']));
    report.refuses(`${title} colour spaces exchanged`, judgeSpaces(exchanged, set.parts));
  }
  const picture = readPngFile(set.tasks[2].out);
  report.check(`${title} picture by Blender, ${path.basename(set.tasks[2].out)}`, judgeRelief(picture, own, mine));
  report.refuses(`${title} picture by Blender, against a relief with green flipped`, judgeRelief(picture, own, normalsOf(own.normal, {greenSign: -1})));
  return undefined;
}

/** Node Wrangler's own words: each file of the preset has one meaning, and the add-on finds it. */
function checkWords({report, files}) {
  const addon = '/usr/share/blender/scripts/addons/node_wrangler.py';
  if (!fs.existsSync(addon)) return report.skip('names by Node Wrangler', `there is no ${addon}`);
  const lists = [...fs.readFileSync(addon, 'utf8').matchAll(/(\w+): StringProperty\(\s*name='[^']*',\s*default='([^']+)'/g)].map(([, slot, words]) => ({slot, words: words.split(' ')}));
  const slotsOf = (file) => {
    const parts = path.basename(file).toLowerCase().split('.')[0].split(/[^a-z0-9]+/);
    return lists.filter(({words}) => words.some((word) => parts.includes(word))).map(({slot}) => slot);
  };
  const judge = (names) => {
    const found = names.map((file) => ({file: path.basename(file), slots: slotsOf(file)}));
    const all = found.map(({slots}) => slots.join('+'));
    const ok = lists.length > 3 && found.every(({slots}) => slots.length === 1) && new Set(all).size === all.length;
    return {ok, says: found.map(({file, slots}) => `${file} is ${slots.join(' and ') || 'nothing'}`).join(', ')};
  };
  report.check('names by Node Wrangler', judge(files));
  report.refuses('names by Node Wrangler with _ORM', judge([...files, files[0].replace(/_[a-z]+\.png$/, '_orm.png')]));
  return undefined;
}

export async function check({report, glbs, images, truth, scratch, folder}) {
  const sets = [
    ...glbs.map((file) => tasksOfGlb(file, truth, folder, scratch)),
    ...(images ? [{...tasksOfImages(images, truth, folder, scratch), sizeLimit: truth.mm_per_pixel ? Math.max(1e-6, truth.mm_per_pixel / 2000) : undefined}] : []),
  ];
  const read = render(sets.flatMap(({tasks}) => tasks), scratch);
  sets.forEach((set, at) => checkOne({report, set, read: read.slice(3 * at, 3 * at + 3), truth}));
  if (images) checkWords({report, files: images.all});
}
