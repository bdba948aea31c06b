// SPDX-License-Identifier: Apache-2.0
// A virtual rig and the daemon that serves it: the real programs.
import {execFile, spawn} from 'node:child_process';
import {createHash} from 'node:crypto';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import {fileURLToPath} from 'node:url';
import {promisify} from 'node:util';

const run = promisify(execFile);
const root = fileURLToPath(new URL('../../../../', import.meta.url));
const programs = process.env.WEFT_PROGRAMS ?? path.join(root, 'build/release/bin');
const virtualRig = path.join(programs, 'weft-virtual-rig');
export const weft = path.join(programs, 'weft');

function readEnvironment(folder) {
  const lines = fs.readFileSync(path.join(folder, 'environment'), 'utf8').trim().split('\n');
  return {...process.env, ...Object.fromEntries(lines.map((line) => line.split(/=(.*)/s).slice(0, 2)))};
}

/** The first line that a program prints. */
export function firstLine(program) {
  return new Promise((resolve, reject) => {
    let said = '';
    program.stdout.on('data', (text) => {
      said += text;
      if (said.includes('\n')) resolve(said.slice(0, said.indexOf('\n')));
    });
    program.on('exit', (code) => reject(new Error(`it ended with ${code} before it said anything`)));
  });
}

/** How late a page may say on a busy machine that its daemon is gone: the unit tests of events.ts hold the three seconds. */
export const mostToTell_ms = 10_000;

/** Asks until it is so. */
export async function until(isSo) {
  for (let asked = 0; asked < 300; asked++) {
    if (await isSo()) return;
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
  throw new Error('it never was so');
}

export class Rig {
  #daemon = null;

  constructor(folder) {
    this.folder = folder;
    this.environment = readEnvironment(folder);
  }

  /** A command of docs/virtual_rig.md. */
  async inject(command) {
    const {stdout} = await run(virtualRig, ['--folder', this.folder, '--inject', command]);
    return stdout;
  }

  /** Starts `weft serve`; `this.address` is where it answers. */
  async serve({port = 0, more = []} = {}) {
    this.#daemon = spawn(weft, ['serve', '--port', String(port), ...more], {env: this.environment, stdio: ['ignore', 'pipe', 'pipe']});
    this.log = '';
    this.#daemon.stderr.on('data', (text) => { this.log += text; });
    this.address = (await firstLine(this.#daemon)).replace(/\/#.*/, '');
    return this.address;
  }

  get port() {
    return Number(new URL(this.address).port);
  }

  /** `signal`: SIGKILL where the daemon is to have no time for a last word. */
  async stopServing(signal = 'SIGTERM') {
    const daemon = this.#daemon;
    this.#daemon = null;
    if (!daemon || daemon.exitCode !== null) return;
    daemon.kill('SIGCONT');  // one that hangs would hear nothing else
    const ended = new Promise((resolve) => daemon.once('exit', resolve));
    daemon.kill(signal);
    await ended;
  }

  /** Stops it in the middle of what it does, its sockets open, and has it go on. */
  hang(hangs) {
    this.#daemon.kill(hangs ? 'SIGSTOP' : 'SIGCONT');
  }

  /** Asks the daemon as curl would. */
  async ask(call, body) {
    const headers = {'Content-Type': 'application/json', ...(this.token && {Authorization: `Bearer ${this.token}`})};
    const response = await fetch(`${this.address}/api/v1/${call}`, body === undefined ? {headers} : {method: 'POST', headers, body: JSON.stringify(body)});
    return response.json();
  }

  /** Scans what lies on the table, and returns its session. */
  async scan(fabric) {
    const {session} = await this.ask('scan', {fabric, cloth_height_mm: 0.8});
    await until(async () => (await this.ask('rig')).phase === 'complete');
    return session;
  }

  /** What the camera's shutter was open for, from the rig's own diary. */
  async exposures() {
    const diary = await fs.promises.readFile(path.join(this.folder, 'exposures.jsonl'), 'utf8');
    return diary.trim().split('\n').map((line) => JSON.parse(line));
  }

  /** As if weft calibrate response had measured how much light one exposure gathers over another. */
  measureRatio(exposure_us, to_exposure_us, ratio) {
    const folder = path.join(this.folder, 'calibration');
    const [file, list] = ['response.json', 'calibration.json'].map((name) => path.join(folder, name));
    const response = {...JSON.parse(fs.readFileSync(file, 'utf8')), exposure_ratios: [{exposure_us, to_exposure_us, ratio}]};
    fs.writeFileSync(file, JSON.stringify(response));
    const digest = createHash('sha256').update(fs.readFileSync(file)).digest('hex');
    const calibration = JSON.parse(fs.readFileSync(list, 'utf8'));
    calibration.parts['response.json'] = digest;
    fs.writeFileSync(list, JSON.stringify(calibration));
  }

  async stop() {
    await this.stopServing();
    await this.inject('end').catch(() => {});
    fs.rmSync(this.folder, {recursive: true, force: true});
  }
}

/** A server without a rig, whose home is a folder that goes with it. */
async function serveWithout(folder, program, words, more = {}) {
  const {WEFT_RIG: _, XDG_DATA_HOME: __, XDG_CONFIG_HOME: ___, ...environment} = process.env;
  const daemon = spawn(program, words, {cwd: folder, env: {...environment, HOME: folder, XDG_STATE_HOME: folder, ...more}, stdio: ['ignore', 'pipe', 'pipe']});
  const ended = new Promise((resolve) => daemon.once('exit', resolve));
  const stop = async () => {
    daemon.kill('SIGTERM');
    await ended;
    fs.rmSync(folder, {recursive: true, force: true});
  };
  return {address: await firstLine(daemon), stop};
}

const newFolder = () => fs.mkdtempSync(path.join(os.tmpdir(), 'weft-page-'));

/** One that shows an empty archive. */
export function serveArchive() {
  const folder = newFolder();
  return serveWithout(folder, weft, ['serve', '--port', '0', '--archive', folder]);
}

/** What the package installs, begun by its desktop entry; `opened` is what it gives the desktop to open. */
export async function serveByIcon() {
  const folder = newFolder();
  await run('cmake', ['--install', path.dirname(programs), '--prefix', '/usr'], {env: {...process.env, DESTDIR: folder}});
  const installed = path.join(folder, 'usr/bin');
  const [, line] = fs.readFileSync(path.join(folder, 'usr/share/applications/weft.desktop'), 'utf8').match(/^Exec=(.*)$/m);
  const opened = path.join(folder, 'opened');
  fs.writeFileSync(path.join(installed, 'xdg-open'), `#!/bin/sh\nprintf %s "$1" >'${opened}.new' && mv '${opened}.new' '${opened}'\n`, {mode: 0o755});
  const served = await serveWithout(folder, 'sh', ['-c', `exec ${line} --port 0`], {PATH: `${installed}:${process.env.PATH}`});
  await until(() => fs.existsSync(opened));
  return {...served, opened: fs.readFileSync(opened, 'utf8')};
}

/** Appends to the rig file. */
function configure(folder, lines) {
  fs.appendFileSync(path.join(folder, 'rig.toml'), `${lines.join('\n')}\n`);
}

function leaveOut(folder, pattern) {
  const file = path.join(folder, 'rig.toml');
  fs.writeFileSync(file, fs.readFileSync(file, 'utf8').replace(pattern, ''));
}

function makeToken(folder) {
  const token = 'a-token-that-nobody-guesses';
  fs.writeFileSync(path.join(folder, 'token'), token, {mode: 0o600});
  configure(folder, ['token = "token"']);
  return token;
}

/**
 * A virtual rig of a scene of testdata/scenes, served. `names`: more names that the daemon answers to; `token`: it wants
 * one; `without`: what is taken out of the rig file; `options`: of weft-virtual-rig.
 */
export async function startRig({scene = 'rig.toml', megapixels = 0.25, options = [], names = [], token = false, without = null} = {}) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'weft-page-'));
  await run(virtualRig, [path.join(root, 'testdata/scenes', scene), '--folder', folder, '--megapixels', String(megapixels), '--no-wait', ...options]);
  const rig = new Rig(folder);
  if (without) leaveOut(folder, without);
  if (names.length) configure(folder, [`names = ${JSON.stringify(names)}`]);
  if (token) rig.token = makeToken(folder);
  await rig.serve().catch(async (error) => {
    await rig.stop();
    throw error;
  });
  return rig;
}
