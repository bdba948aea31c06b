// SPDX-License-Identifier: Apache-2.0
import {spawnSync} from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';

export const here = path.resolve(import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname), '..');

/** Debian's Python, whose modules are Debian's; another one on the path has none of them. */
export const python = process.env.WEFT_PYTHON ?? '/usr/bin/python3';

export function has(program) {
  if (program.includes('/')) return fs.existsSync(program);
  return (process.env.PATH ?? '').split(path.delimiter).some((folder) => folder && fs.existsSync(path.join(folder, program)));
}

export function hasModule(module) {
  return has(python) && run(python, ['-c', `import ${module}`]).code === 0;
}

export function run(program, args, {seconds = 120, binary = false} = {}) {
  const done = spawnSync(program, args, {
    timeout: seconds * 1000, maxBuffer: 1 << 30, encoding: binary ? 'buffer' : 'utf8',
    env: {...process.env, LC_ALL: 'C.UTF-8', TZ: 'UTC'},
  });
  if (done.error) return {code: -1, out: done.stdout ?? '', err: `${program}: ${done.error.message}`};
  return {code: done.status ?? -1, out: done.stdout, err: String(done.stderr)};
}

/** The first line that says something. */
export function firstLine(...texts) {
  return texts.join('\n').split('\n').map((line) => line.trim()).find(Boolean) ?? 'not a word';
}

/** A program's verdict on a file, by its exit code. */
export function byExitCode(program, args) {
  const {code, out, err} = run(program, args);
  return {ok: code === 0, says: code === 0 ? `${program} ${firstLine(out, 'is content')}` : `${program}: exit code ${code}, ${firstLine(err, out)}`};
}
