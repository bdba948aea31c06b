// SPDX-License-Identifier: Apache-2.0
// export.json: digests are those of the files, and it leads back to the maps. node:crypto is the stranger.
import crypto from 'node:crypto';
import fs from 'node:fs';
import path from 'node:path';
import {all} from '../support/report.mjs';

const digestOf = (file) => crypto.createHash('sha256').update(fs.readFileSync(file)).digest('hex');

function judgeDigests(folder, document) {
  const there = [...document.files, ...document.documents].filter(({file}) => fs.existsSync(path.join(folder, file)));
  return all(there.map(({file, sha256}) => ({ok: digestOf(path.join(folder, file)) === sha256, says: `${file} is its digest's`}))
    .map(({ok, says}) => (ok ? {ok, says: `${there.length} files are their digests'`} : {ok, says: says.replace(' is ', ' is not ')})));
}

function judgeOrigin({from}, truth) {
  const digest = from[`${truth.kind}_sha256`];
  return {ok: from[truth.kind] === truth.facts.id && digest === digestOf(truth.file), says: `made of ${truth.kind} ${from[truth.kind]}`};
}

export async function check({report, root, truth}) {
  for (const name of fs.readdirSync(root).sort()) {
    const folder = path.join(root, name);
    const said = path.join(folder, 'export.json');
    if (!fs.existsSync(said)) continue;
    const document = JSON.parse(fs.readFileSync(said, 'utf8'));
    report.check(`${name}/export.json`, judgeDigests(folder, document));
    const twin = structuredClone(document);
    for (const file of [...twin.files, ...twin.documents]) file.sha256 = file.sha256.replace(/^./, (digit) => (digit === '0' ? '1' : '0'));
    report.refuses(`${name}/export.json with other digests`, judgeDigests(folder, twin));
    report.check(`${name}/export.json its origin`, judgeOrigin(document, truth));
    report.refuses(`${name}/export.json for other maps`, judgeOrigin(document, {...truth, facts: {id: '0000000000000000'}}));
  }
}
