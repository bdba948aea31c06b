// SPDX-License-Identifier: Apache-2.0
// Documents that weft writes, of every version there ever was, against the schemas that it ships, by ajv: each as it
// is, and a broken twin for each of its fields, which must be refused where the schema knows the field.
import fs from 'node:fs';
import path from 'node:path';
import {execFileSync} from 'node:child_process';
import Ajv from 'ajv/dist/2020.js';

if (process.argv.length < 4) {
  process.stderr.write('node documents.mjs WEFT FOLDER...\n  WEFT    the program, whose schemas are tried\n  FOLDER  with documents, at any depth\n');
  process.exit(64);
}
const [weft, ...folders] = process.argv.slice(2);
const ajv = new Ajv({strict: false});
const schemas = new Map(execFileSync(weft, ['schema'], {encoding: 'utf8'}).trim().split('\n').map((line) => {
  const [name] = line.split(' ');
  return [name, ajv.compile(JSON.parse(execFileSync(weft, ['schema', name], {encoding: 'utf8'})))];
}));

function* documentsBelow(folder) {
  for (const entry of fs.readdirSync(folder, {withFileTypes: true, recursive: true})) {
    const file = path.join(entry.parentPath ?? entry.path, entry.name);
    if (!entry.isFile() || !/\.jsonl?$/.test(file)) continue;
    const text = fs.readFileSync(file, 'utf8');
    const lines = file.endsWith('l') ? text.trim().split('\n') : [text];
    for (const [at, line] of lines.entries()) yield {where: `${file}${at ? `:${at + 1}` : ''}`, document: JSON.parse(line)};
  }
}

function nameOf(document) {
  if (typeof document.schema === 'string') return document.schema.split('/')[0];
  if ('left_out' in document) return 'weft.batch-left-out';
  return 'predicted_deg' in document ? 'weft.batch-session' : undefined;
}

const seen = new Map(), failures = [];
let twins = 0;
for (const folder of folders) {
  for (const {where, document} of documentsBelow(folder)) {
    const name = nameOf(document), validate = schemas.get(name);
    if (!validate) continue;
    seen.set(name, (seen.get(name) ?? 0) + 1);
    if (!validate(document)) failures.push(`${where}: ${ajv.errorsText(validate.errors)}`);
    for (const field of Object.keys(document)) {
      if (validate.schema.properties[field]?.type === undefined) continue;
      const broken = {...document, [field]: typeof document[field] === 'string' ? 7 : 'seven'};
      twins += 1;
      if (validate(broken)) failures.push(`${where}: ${field} may be ${JSON.stringify(broken[field])}`);
    }
  }
}
const untried = [...schemas.keys()].filter((name) => !seen.has(name));
for (const failure of failures) process.stdout.write(`${failure}\n`);
if (untried.length) process.stdout.write(`none was there of ${untried.join(', ')}\n`);
process.stdout.write(`${[...seen.values()].reduce((sum, count) => sum + count, 0)} documents of ${seen.size} schemas, ${twins} broken twins, ${failures.length} failures\n`);
process.exit(failures.length ? 1 : 0);
