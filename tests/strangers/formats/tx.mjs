// SPDX-License-Identifier: Apache-2.0
// .tx: iinfo and oiiotool, the tools of the library that renderers read it with, tell tiles, levels, wrapping and means.
import fs from 'node:fs';
import path from 'node:path';
import {sampleOf} from '../support/catalogue.mjs';
import {readPixels} from '../support/pixels.mjs';
import {run} from '../support/programs.mjs';
import {all, below} from '../support/report.mjs';
import {judgeFile} from './images.mjs';

function levelsDownToOne(width, height) {
  const levels = [];
  for (let [w, h] = [width, height]; ; [w, h] = [Math.max(1, w >> 1), Math.max(1, h >> 1)]) {
    levels.push(`${w}x${h}`);
    if (w === 1 && h === 1) return levels;
  }
}

function judgeLayout(out, truth) {
  const levels = /MIP-map levels: (.*)/.exec(out)?.[1].trim().split(' ') ?? [];
  return all([
    {ok: /openexr/.test(out), says: 'openexr'},
    {ok: /tile size: 64 x 64/.test(out), says: /tile size: .*/.exec(out)?.[0] ?? 'no tiles'},
    {ok: levels.join(' ') === levelsDownToOne(truth.width, truth.height).join(' '), says: `${levels.length} levels`},
    {ok: /wrapmodes: "(periodic|periodic,periodic|black,black|clamp,clamp)"/.test(out), says: /wrapmodes: .*/.exec(out)?.[0] ?? 'no wrapping'},
    {ok: /textureformat: "Plain Texture"/.test(out), says: 'a texture'},
  ]);
}

function judgeMeans(out, entry, truth, off = 0) {
  const means = /Stats Avg: ([^(]*)/.exec(out)?.[1].trim().split(/\s+/).map(Number) ?? [];
  const verdicts = [];
  entry.channels.forEach((name, at) => {
    const sample = sampleOf(at, truth, entry);
    if (!sample) return;
    let sum = 0;
    for (let texel = 0; texel < truth.width * truth.height; texel += 1) sum += sample(texel);
    verdicts.push(below(Math.abs(means[at] - sum / (truth.width * truth.height) - off), 2e-4, '', ` of the mean of ${name}`));
  });
  return all(verdicts);
}

/** The words on each file of a program that speaks of one after the other: a part begins with the file's name. */
function partsOf(out, files) {
  const starts = files.map((file) => out.indexOf(`${file} `));
  return files.map((_, at) => (starts[at] < 0 ? '' : out.slice(starts[at], starts[at + 1] > 0 ? starts[at + 1] : undefined)));
}

export async function check({report, entries, truth, scratch}) {
  const files = entries.map(({file}) => file);
  const layouts = partsOf(run('iinfo', ['-v', ...files]).out, files);
  const stats = partsOf(run('oiiotool', ['--stats', '--info', ...files]).out, files);
  entries.forEach((entry, at) => {
    report.check(`${entry.title} by iinfo`, judgeLayout(layouts[at], truth));
    report.refuses(`${entry.title} for a cloth twice as wide`, judgeLayout(layouts[at], {...truth, width: 2 * truth.width}));
    report.check(`${entry.title} by oiiotool`, judgeMeans(stats[at], entry, truth));
    report.refuses(`${entry.title} with a mean 0.001 off`, judgeMeans(stats[at], entry, truth, 0.001));
  });
  const levels = readPixels('openimageio', files);
  entries.forEach((entry, at) => judgeFile({report, entry, texels: levels[at], truth, reader: 'openimageio'}));
  const cut = path.join(scratch, 'cut.tx');
  const bytes = fs.readFileSync(files[0]);
  fs.writeFileSync(cut, bytes.subarray(0, bytes.length >> 1));
  const broken = run('oiiotool', ['--stats', '--info', cut]);
  report.refuses(`${entries[0].title} cut short, by oiiotool`, judgeMeans(broken.code === 0 ? broken.out : '', entries[0], truth));
}
