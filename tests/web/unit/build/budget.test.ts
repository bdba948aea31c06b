// SPDX-License-Identifier: Apache-2.0
// What comes over the network, packed: a tablet on a slow one waits for it.
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import {fileURLToPath} from 'node:url';
import {expect, test} from 'vitest';

const dist = fileURLToPath(new URL('../../../../app/web/dist/', import.meta.url));
const index = fs.readFileSync(path.join(dist, 'index.html'), 'utf8');
const files = ['index.html', ...fs.readdirSync(path.join(dist, 'assets')).map((file) => `assets/${file}`)];

/** As app/server/page packs it. */
function kilobytesOf(names: string[]): number {
  return names.reduce((sum, name) => sum + execFileSync('zopfli', ['-c', path.join(dist, name)]).length, 0) / 1000;
}

/** What the page asks for before it shows anything: what index.html names, and what the desk is made of. */
function firstLoad(): string[] {
  const script = fs.readFileSync(path.join(dist, files.find((file) => /assets\/index-.*\.js$/.test(file)) ?? ''), 'utf8');
  const [, desk = ''] = script.match(/import\("\.\/(desk-[^"]+)"\)/) ?? [];
  const body = fs.readFileSync(path.join(dist, 'assets', desk), 'utf8');
  const parts = [...body.matchAll(/from"\.\/([^"]+)"/g)].map(([, part]) => `assets/${part}`);
  return files.filter((file) => index.includes(`/${file}`) || file === 'index.html' || file === `assets/${desk}` || parts.includes(file));
}

test('the first load with the desk is at most 40 kB', () => {
  const kilobytes = kilobytesOf(firstLoad());
  expect(firstLoad().length).toBeGreaterThan(3);
  expect(kilobytes, `${kilobytes.toFixed(1)} kB`).toBeLessThan(40);
});

test('all of it is at most 110 kB', () => {
  const kilobytes = kilobytesOf(files);
  expect(kilobytes, `${kilobytes.toFixed(1)} kB`).toBeLessThan(110);
});

test('what draws a report, which each report carries, is at most 25 kB', () => {
  const kilobytes = fs.statSync(path.join(dist, 'report.js')).size / 1000;
  expect(kilobytes, `${kilobytes.toFixed(1)} kB`).toBeLessThan(25);
});

test('nothing of it names another host', () => {
  const others = [...files, 'report.js'].filter((file) => /https?:\/\/(?!www\.w3\.org\/)[a-z]/.test(fs.readFileSync(path.join(dist, file), 'utf8')));
  expect(others).toEqual([]);
});
