// SPDX-License-Identifier: Apache-2.0
// .tx: iinfo and oiiotool, the tools of the library that renderers read it with, tell tiles, levels, wrapping and means.
import fs from 'node:fs';
import path from 'node:path';
import {sampleOf} from '../support/catalogue.mjs';
import {run} from '../support/programs.mjs';
import {all, below} from '../support/report.mjs';

function levelsDownToOne(width, height) {
  const levels = [];
  for (let [w, h] = [width, height]; ; [w, h] = [Math.max(1, w >> 1), Math.max(1, h >> 1)]) {
    levels.push(`${w}x${h}`);
    if (w === 1 && h === 1) return levels;
  }
}

function judgeLayout(out, truth, code = 0) {
  if (code !== 0) return {ok: false, says: out.trim().split('\n')[0] || `exit code ${code}`};
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

export async function check({report, entries, truth, scratch}) {
  for (const entry of entries.filter(({encoding}) => encoding === 'tx')) {
    const {code, out, err} = run('iinfo', ['-v', entry.file]);
    report.check(`${entry.title} by iinfo`, judgeLayout(out + err, truth, code));
    report.refuses(`${entry.title} for a cloth twice as wide`, judgeLayout(out, {...truth, width: 2 * truth.width}));
    const stats = run('oiiotool', ['--stats', '--info', entry.file]).out;
    report.check(`${entry.title} by oiiotool`, judgeMeans(stats, entry, truth));
    report.refuses(`${entry.title} with a mean 0.001 off`, judgeMeans(stats, entry, truth, 0.001));
    const cut = path.join(scratch, `cut_${path.basename(entry.file)}`);
    const bytes = fs.readFileSync(entry.file);
    fs.writeFileSync(cut, bytes.subarray(0, bytes.length >> 1));
    const broken = run('oiiotool', ['--stats', '--info', cut]);
    report.refuses(`${entry.title} cut in the middle, by oiiotool`, judgeMeans(broken.code === 0 ? broken.out : '', entry, truth));
  }
}
