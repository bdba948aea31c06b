// SPDX-License-Identifier: Apache-2.0
// PNG, TIFF and EXR: pngjs, Pillow, OpenImageIO and three's EXRLoader read texels, pngcheck the container, exiftool
// what the file says of itself.
import fs from 'node:fs';
import path from 'node:path';
import {EXRLoader} from '../node_modules/three/examples/jsm/loaders/EXRLoader.js';
import {angles, normalsOf, sameSize} from '../support/compare.mjs';
import {isNormal, sampleOf} from '../support/catalogue.mjs';
import {halfStep} from '../support/judges.mjs';
import {readPixels, readPngFile} from '../support/pixels.mjs';
import {byExitCode, has, run} from '../support/programs.mjs';
import {all, below, sameLength} from '../support/report.mjs';

/** Every channel that the catalogue knows, against the maps; `order` permutes the channels for a twin. Blocks and .tx are judged by what they are said to lose. */
function judgeTexels(texels, entry, truth, order = (at) => at) {
  const size = sameSize(texels, truth);
  if (!size.ok) return size;
  const verdicts = [];
  entry.channels.forEach((name, at) => {
    const sample = sampleOf(at, truth, entry);
    if (!sample) return;
    const channel = texels.channels > 1 ? order(at) : 0;
    let most = 0;
    for (let texel = 0; texel < truth.width * truth.height; texel += 1) {
      const off = Math.abs(texels.data[texel * texels.channels + channel] - sample(texel));
      if (!(off <= most)) most = off;
    }
    const limit = texels.whole ? halfStep(texels) : halfStep(texels) * Math.max(1, ...(entry.ranges[at] ?? [1]).map(Math.abs));
    verdicts.push(below(most, limit, '', ` of ${name} at most`));
  });
  if (!verdicts.length) return null;
  const bad = verdicts.filter(({ok}) => !ok);
  if (bad.length) return all(bad);
  return {ok: true, says: `${verdicts[0].says}${verdicts.length > 1 ? ` and ${verdicts.length - 1} channels more` : ''}`};
}

/** Whether channels that are exchanged are different ones. */
function canTell(entry, truth, order) {
  return entry.channels.some((_, at) => {
    const [one, other] = [sampleOf(at, truth, entry), entry.channels[order(at)] && sampleOf(order(at), truth, entry)];
    if (!one || !other) return false;
    for (let texel = 0; texel < truth.width * truth.height; texel += 1) if (Math.abs(one(texel) - other(texel)) > 0.05) return true;
    return false;
  });
}

/** What export.json says that blocks lose, against what this reader sees: decibels of colours, means of data. */
function judgeBlocks(texels, entry, truth, order = (at) => at) {
  const size = sameSize(texels, truth);
  if (!size.ok) return size;
  const verdicts = [];
  let [squares, colors] = [0, 0];
  entry.channels.forEach((name, at) => {
    const sample = sampleOf(at, truth, entry);
    if (!sample || isNormal(name)) return;
    let [sum, square] = [0, 0];
    const count = truth.width * truth.height;
    for (let texel = 0; texel < count; texel += 1) {
      const off = Math.abs(texels.data[texel * texels.channels + order(at)] - sample(texel));
      sum += off;
      square += off * off;
    }
    if (name.startsWith('albedo.')) {
      squares += square / count;
      colors += 1;
    } else {
      const [least, most] = entry.ranges[at];
      verdicts.push(below(Math.abs(sum / count - entry.means[at] / Math.max(1e-9, most - least)), 0.003, '', ` between what ${name} loses and is said to`));
    }
  });
  if (colors && entry.lost.albedo?.psnr_db) {
    const psnr_db = 10 * Math.log10(colors / squares);
    verdicts.push(below(Math.abs(psnr_db - entry.lost.albedo.psnr_db), 0.2, ' dB', ` between ${psnr_db.toFixed(2)} dB of the albedo and what is said`));
  }
  return verdicts.length ? all(verdicts) : null;
}

function normalsIn(texels, entry, greenSign) {
  const z = entry.channels.indexOf('normal.z');
  const stored = ['exr', 'tx'].includes(entry.encoding);
  return normalsOf(texels, {greenSign, rebuildZ: z < 0, stored, channels: [entry.channels.indexOf('normal.x'), entry.channels.indexOf('normal.y'), z]});
}

function judgeDirection(texels, entry, truth, greenSign) {
  const size = sameSize(texels, truth);
  if (!size.ok) return size;
  const {mean, most} = angles(normalsIn(texels, entry, greenSign), truth.normal);
  const limit = entry.encoding === 'dds' ? entry.lost.normal_deg.mean + 0.1 : texels.bits === 8 ? 0.2 : texels.whole || texels.bits === 32 ? 0.01 : 0.02;
  return below(mean, limit, ' deg', `, most ${most.toFixed(2)}, tilt below 40 deg`);
}

/** Degrees that export.json says are lost, over all tilts, against what this reader sees. */
function judgeSaidLoss(texels, entry, truth, greenSign) {
  const {mean} = angles(normalsIn(texels, entry, greenSign), truth.normal, 180);
  const said = entry.lost.normal_deg.mean;
  // Graphics hardware rounds what a block says to 8 bits.
  const limit = entry.encoding === 'dds' ? 0.1 : 0.02 * said + 0.0005;
  return below(Math.abs(mean - said), limit, ' deg', ` between the ${mean.toFixed(4)} that are lost over all tilts and what is said`);
}

function judgeNormals({report, entry, texels, truth, title}) {
  const green = entry.direction === 'directx' ? -1 : 1;
  report.check(`${title} its normals`, judgeDirection(texels, entry, truth, green));
  report.refuses(`${title} with green flipped`, judgeDirection(texels, entry, truth, -green));
  if (!entry.lost?.normal_deg) return;
  report.check(`${title} what its normals lose`, judgeSaidLoss(texels, entry, truth, green));
  report.refuses(`${title} what its normals lose with green flipped`, judgeSaidLoss(texels, entry, truth, -green));
}

/** What a reader found in a file, held against the maps, and twins of it. */
export function judgeFile({report, entry, texels, truth, reader}) {
  const title = `${entry.title} by ${reader}`;
  if (texels.error) return report.check(title, {ok: false, says: texels.error});
  const judge = entry.encoding === 'dds' ? judgeBlocks : judgeTexels;
  const verdict = judge(texels, entry, truth);
  const exchange = (at) => [1, 2, 0, 3][at] % texels.channels;
  if (verdict) report.check(`${title}, ${texels.bits} bits`, verdict);
  if (verdict?.ok && canTell(entry, truth, exchange)) report.refuses(`${title} with channels exchanged`, judge(texels, entry, truth, exchange));
  if (entry.channels.includes('normal.x')) judgeNormals({report, entry, texels, truth, title});
  return undefined;
}

function byThree(file) {
  const bytes = fs.readFileSync(file);
  const loader = new EXRLoader();
  loader.type = 1015;
  const {width, height, data} = loader.parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
  const out = new Float32Array(data.length);
  const row = 4 * width;
  for (let y = 0; y < height; y += 1) out.set(data.subarray(y * row, (y + 1) * row), (height - 1 - y) * row);
  return {width, height, channels: 4, bits: 16, whole: false, data: out};
}

/** Readers of a file that are not OpenImageIO, as far as they keep its bits, and OpenImageIO where there is none. */
function readersOf({encoding, bits, channels}) {
  if (encoding === 'png') return bits === 8 || channels.length === 1 ? ['pngjs', 'pillow'] : ['pngjs'];
  if (encoding === 'tiff') return bits === 8 || channels.length === 1 ? ['pillow', 'openimageio'] : ['openimageio'];
  return channels[0] === 'albedo.r' ? ['three', 'openimageio'] : ['openimageio'];
}

function textsOf(reader, files) {
  const quietly = (read) => files.map((file) => {
    try {
      return read(file);
    } catch (error) {
      return {error: String(error.message ?? error)};
    }
  });
  if (reader === 'pngjs') return quietly(readPngFile);
  return reader === 'three' ? quietly(byThree) : readPixels(reader, files);
}

function checkTexels({report, entries, truth, skips}) {
  for (const reader of ['pngjs', 'pillow', 'three', 'openimageio']) {
    const mine = entries.filter((entry) => readersOf(entry).includes(reader));
    if (!mine.length) continue;
    if (skips[reader]) {
      report.skip(`texels by ${reader}`, skips[reader]);
      continue;
    }
    const read = textsOf(reader, mine.map(({file}) => file));
    mine.forEach((entry, at) => judgeFile({report, entry, texels: read[at], truth, reader}));
  }
}

/** Each kind of file, cut in the middle, is refused by each of its readers; a TIFF is cut sooner, since OpenImageIO fills up what a strip lacks. */
function checkBroken({report, entries, scratch, skips}) {
  for (const encoding of ['png', 'tiff', 'exr']) {
    const entry = entries.find((one) => one.encoding === encoding);
    if (!entry) continue;
    const bytes = fs.readFileSync(entry.file);
    const cut = path.join(scratch, `cut_${path.basename(entry.file)}`);
    fs.writeFileSync(cut, bytes.subarray(0, encoding === 'tiff' ? 100 : bytes.length >> 1));
    const readers = [...new Set([...readersOf(entry), 'openimageio'])].filter((reader) => !skips[reader]);
    for (const reader of readers) {
      const [read] = textsOf(reader, [cut]);
      report.refuses(`${entry.title} cut short, by ${reader}`, {ok: !read.error, says: read.error ?? 'texels'});
    }
  }
}

function checkPngs({report, entries, scratch}) {
  const files = entries.filter(({encoding}) => encoding === 'png').map(({file}) => file);
  if (!files.length) return;
  if (!has('pngcheck')) return report.skip('PNG by pngcheck', 'there is no pngcheck (Debian\'s pngcheck)');
  const {code, out} = run('pngcheck', ['-q', ...files]);
  report.check(`${files.length} files by pngcheck`, {ok: code === 0, says: code === 0 ? 'no errors' : out.split('\n')[0]});
  const bytes = fs.readFileSync(files[0]);
  bytes[bytes.length >> 1] ^= 1;
  const twin = path.join(scratch, `bit_${path.basename(files[0])}`);
  fs.writeFileSync(twin, bytes);
  report.refuses(`${path.basename(files[0])} with a flipped bit, by pngcheck`, byExitCode('pngcheck', ['-q', twin]));
  return undefined;
}

function checkTiffs({report, entries, scratch}) {
  const entry = entries.find(({encoding}) => encoding === 'tiff');
  if (!entry) return undefined;
  if (!has('tiffinfo')) return report.skip('TIFF by tiffinfo', 'there is no tiffinfo (Debian\'s libtiff-tools)');
  const judge = (file) => {
    const {code, out, err} = run('tiffinfo', ['-D', file]);
    return {ok: code === 0 && !err.trim() && /TIFF Directory/.test(out), says: err.trim().split('\n')[0] || 'no errors in the data'};
  };
  const files = entries.filter(({encoding}) => encoding === 'tiff').map(({file}) => file);
  report.check(`${files.length} files by tiffinfo`, all(files.map(judge)));
  const bytes = fs.readFileSync(entry.file);
  const twin = path.join(scratch, `cut_data_${path.basename(entry.file)}`);
  bytes.fill(0, 64, bytes.length >> 1);
  fs.writeFileSync(twin, bytes);
  return report.refuses(`${entry.title} with zeros for data, by tiffinfo`, judge(twin));
}

/** Millimetres a pixel of what exiftool found in a file, along both axes. */
function mmOf(tags) {
  const find = (name) => Object.entries(tags).find(([tag]) => tag.endsWith(`:${name}`))?.[1];
  const [x, y] = ['PixelsPerUnitX', 'PixelsPerUnitY'].map(find);
  if (x) return find('PixelUnits') === 1 ? {mm: [1000 / x, 1000 / y], step: 0.5 / x} : null;
  const [width, height] = [find('XResolution'), find('YResolution') ?? find('XResolution')];
  const unit = {2: 25.4, 3: 10, in: 25.4, cm: 10}[find('ResolutionUnit')];
  return width && unit ? {mm: [unit / width, unit / height], step: 0} : null;
}

function judgePhysicalSize(tags, mm_per_pixel) {
  const found = mmOf(tags);
  if (!found) return {ok: false, says: 'no resolution'};
  return all(found.mm.map((mm) => sameLength(mm, mm_per_pixel, Math.max(1e-6, found.step), 'mm a pixel')));
}

/** sRGB is said of colours and of nothing else; no gamma of 1, which browsers would undo; no date of today. */
function judgeWords(tags, entry) {
  const names = Object.keys(tags).map((tag) => tag.split(':')).filter(([group]) => !['System', 'ExifTool', 'File', 'Composite'].includes(group)).map(([, name]) => name);
  const srgb = names.includes('SRGBRendering');
  // That of an ICC profile is the profile's own, the same in every file.
  const verdicts = [{ok: !names.some((name) => /Date/.test(name) && name !== 'ProfileDateTime'), says: 'no date'}];
  if (entry.encoding === 'png') {
    verdicts.push({ok: srgb === (entry.color === 'srgb'), says: srgb ? 'sRGB' : 'no sRGB chunk'});
    verdicts.push({ok: entry.color === 'srgb' || !names.includes('Gamma'), says: 'no gamma of data'});
  }
  return all(verdicts);
}

export function tagsOf(files) {
  const {out, err} = run('exiftool', ['-json', '-n', '-a', '-G1', ...files]);
  const read = new Map(JSON.parse(out || '[]').map((tags) => [path.resolve(tags.SourceFile), tags]));
  return files.map((file) => read.get(path.resolve(file)) ?? {error: err});
}

function checkTags({report, entries, truth}) {
  if (!has('exiftool')) return report.skip('sizes by exiftool', 'there is no exiftool (Debian\'s libimage-exiftool-perl)');
  const tags = tagsOf(entries.map(({file}) => file));
  entries.forEach((entry, at) => {
    if (truth.mm_per_pixel) {
      report.check(`${entry.title} size by exiftool`, judgePhysicalSize(tags[at], truth.mm_per_pixel));
      report.refuses(`${entry.title} size for pixels a ten thousandth larger`, judgePhysicalSize(tags[at], truth.mm_per_pixel * 1.0001));
    } else {
      report.refuses(`${entry.title} a size where none is known`, {ok: mmOf(tags[at]) !== null, says: 'no resolution'});
    }
    report.check(`${entry.title} its words by exiftool`, judgeWords(tags[at], entry));
    if (entry.encoding === 'png') {
      const other = {...entry, color: entry.color === 'srgb' ? 'data' : 'srgb'};
      report.refuses(`${entry.title} its words, were it ${other.color}`, judgeWords(tags[at], other));
    }
  });
  return undefined;
}

export async function check({report, entries, truth, scratch, skips}) {
  const images = entries.filter(({encoding}) => ['png', 'tiff', 'exr'].includes(encoding));
  checkPngs({report, entries: images, scratch});
  checkTiffs({report, entries: images, scratch});
  checkBroken({report, entries: images, scratch, skips});
  checkTexels({report, entries: images, truth, skips});
  checkTags({report, entries: images, truth});
}
