// SPDX-License-Identifier: Apache-2.0
// Sessions that are simulated and solved by the real programs, and the daemon that shows them without a rig.
import {execFile, spawn} from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import {promisify} from 'node:util';
import {firstLine, weft} from './rig.mjs';

const run = promisify(execFile);

export class Archive {
  #daemon = null;
  #solves = new Map();

  /** `sessions`: a folder of some that are there already. */
  constructor(sessions) {
    this.folder = fs.mkdtempSync(path.join(os.tmpdir(), 'weft-page-'));
    this.sessions = sessions ?? path.join(this.folder, 'sessions');
    fs.mkdirSync(this.sessions, {recursive: true});
  }

  /** Simulates a scene (text of TOML) and solves it at each level. */
  async add(name, scene, ...levels) {
    const file = path.join(this.folder, `${name}.toml`);
    const session = path.join(this.sessions, `${name}.weft`);
    fs.writeFileSync(file, scene);
    await run(weft, ['simulate', file, '-o', session, '--quiet']);
    for (const level of levels) {
      const {stdout} = await run(weft, ['solve', session, '--quality', level, '--no-previews', '--json', '--quiet']);
      this.#solves.set(`${name} ${level}`, JSON.parse(stdout).id);
    }
  }

  /** Runs a verb on a session. */
  async make(verb, name, ...more) {
    await run(weft, [verb, path.join(this.sessions, `${name}.weft`), ...more, '--quiet']);
  }

  /** A file below the home of whoever serves. */
  write(name, text) {
    const file = path.join(this.folder, name);
    fs.mkdirSync(path.dirname(file), {recursive: true});
    fs.writeFileSync(file, text);
  }

  /** The id of the solve of a session at a level. */
  solve(name, level) {
    return this.#solves.get(`${name} ${level}`);
  }

  /** At the same port as before, where it was served already. */
  async serve() {
    const environment = {...process.env, HOME: this.folder, XDG_STATE_HOME: path.join(this.folder, 'state')};
    for (const other of ['WEFT_RIG', 'XDG_DATA_HOME', 'XDG_CONFIG_HOME']) delete environment[other];
    this.#daemon = spawn(weft, ['serve', '--port', this.address ? new URL(this.address).port : '0', '--archive', this.sessions], {env: environment, cwd: this.folder, stdio: ['ignore', 'pipe', 'ignore']});
    this.address = await firstLine(this.#daemon);
  }

  async ask(call, body) {
    const posted = {method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify(body)};
    return (await fetch(`${this.address}/api/v1/${call}`, body === undefined ? {} : posted)).json();
  }

  async restart() {
    await this.#end();
    await this.serve();
  }

  async #end() {
    const ended = new Promise((resolve) => this.#daemon?.once('exit', resolve));
    if (this.#daemon?.kill('SIGTERM')) await ended;
  }

  async stop() {
    await this.#end();
    fs.rmSync(this.folder, {recursive: true, force: true});
  }
}
