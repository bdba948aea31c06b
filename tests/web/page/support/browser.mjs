// SPDX-License-Identifier: Apache-2.0
// One Chromium for all tests of a file, and a guard over each page: what it may not do fails its test.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import {chromium} from 'playwright-core';
import {PNG} from 'pngjs';

const program = process.env.CHROMIUM ?? '/usr/bin/chromium-headless-shell';
const flags = [
  '--no-sandbox', '--use-angle=swiftshader-webgl', '--enable-unsafe-swiftshader', '--force-color-profile=srgb',
  '--font-render-hinting=none', '--hide-scrollbars', '--disable-quic', '--no-first-run',
  '--disable-background-networking', '--disable-component-update', '--disable-sync',
];
const axe = fs.readFileSync(new URL('../../node_modules/axe-core/axe.min.js', import.meta.url), 'utf8');
const impatience_ms = 40_000;  // tiles are cut after everything else that a machine does

/** Files from a folder have no address, and from there a browser lets nobody ask this machine. */
const fromFolder = process.env.WEFT_DIST ? ['--disable-features=LocalNetworkAccessChecks'] : [];

export function launch(...more) {
  return chromium.launch({executablePath: program, headless: true, args: [...flags, ...fromFolder, ...more]});
}

/** A person at a browser of their own. */
export class Visitor {
  #faults = [];
  #mayFail = [/status of 400 .*\/jobs\/\d+\/cancel$/];  // the job had just ended

  constructor(context, origins) {
    this.context = context;
    this.origins = origins;
    context.setDefaultTimeout(impatience_ms);
    context.on('page', (page) => this.#watch(page));
  }

  #watch(page) {
    page.on('pageerror', (error) => this.#faults.push(`error: ${error.message}`));
    page.on('console', (message) => {
      if (message.type() === 'error') this.#faults.push(`console: ${message.text()} ${message.location().url}`);
    });
    page.on('request', (request) => {
      const {protocol, origin} = new URL(request.url());
      if (protocol.startsWith('http') && !this.origins.includes(origin)) this.#faults.push(`asked elsewhere: ${request.url()}`);
    });
  }

  /** What a test provokes: console errors that match are as they should be. */
  mayFail(...patterns) {
    this.#mayFail.push(...patterns);
  }

  /** What is asked by this pattern waits until it may arrive. */
  async hold(pattern) {
    let told, letGo;
    const asked = new Promise((resolve) => { told = resolve; });
    const gone = new Promise((resolve) => { letGo = resolve; });
    await this.context.route(pattern, async (route) => {
      told();
      await gone;
      await route.fallback();
    });
    const arrive = async (page) => {
      const answered = page.waitForResponse(pattern);
      letGo();
      await (await answered).finished();
      await page.waitForTimeout(100);  // what the page makes of it
    };
    return {asked, arrive};
  }

  async open(address) {
    const page = await this.context.newPage();
    await page.goto(address);
    return page;
  }

  /** Ends, and fails where a page did what it may not. */
  async leave() {
    await this.context.close();
    assert.deepEqual(this.#faults.filter((fault) => !this.#mayFail.some((pattern) => pattern.test(fault))), []);
  }
}

export async function visit(browser, rig, {width = 1280, height = 800, origins = [rig.address]} = {}) {
  const context = await browser.newContext({viewport: {width, height}, deviceScaleFactor: 1, reducedMotion: 'reduce', serviceWorkers: 'block'});
  if (process.env.WEFT_DIST) await serveFrom(context, process.env.WEFT_DIST, rig);
  return new Visitor(context, origins);
}

/** For who changes the page: its files from a folder, as long as the daemon is there, the rest from it. */
async function serveFrom(context, folder, rig) {
  const policy = (await fetch(rig.address)).headers.get('content-security-policy');
  const types = {'.js': 'text/javascript', '.css': 'text/css', '.svg': 'image/svg+xml', '.html': 'text/html'};
  await context.route(/^[^?]*\/\/[^/]+\/(?!api\/)/, async (route) => {
    const isThere = await fetch(`${rig.address}/api/v1/healthz`).then(() => true, () => false);
    if (!isThere) return route.abort('connectionrefused');
    const {pathname} = new URL(route.request().url());
    const file = path.join(folder, pathname.startsWith('/assets/') ? pathname : 'index.html');
    return route.fulfill({body: fs.readFileSync(file), headers: {'content-security-policy': policy, 'content-type': types[path.extname(file)]}});
  });
}

/** What axe finds wrong with what is shown: rule and element. */
export async function violations(page) {
  // A screen has a heading: until then it is still fetched.
  await page.locator('h1').first().waitFor({state: 'attached'});
  await page.evaluate(axe);
  const result = await page.evaluate(() => window.axe.run(document, {resultTypes: ['violations']}));
  return result.violations.flatMap(({id, nodes}) => nodes.map((node) => `${id}: ${node.target.join(' ')}: ${node.failureSummary}`));
}

/** A telephone, a window at 200 percent, a laptop and a wall. */
const windows = [[390, 844], [640, 400], [1280, 800], [3840, 2160]];

/** The same in windows of all widths, and which of them show only a part of what is there; `name` is of its pictures. */
export async function violationsByWidth(page, name) {
  const before = page.viewportSize();
  const found = [];
  for (const [width, height] of windows) {
    await page.setViewportSize({width, height});
    const here = await violations(page);
    const needed = await page.evaluate(() => Math.max(document.documentElement.scrollWidth, document.querySelector('main').scrollWidth));
    if (needed > width) here.push(`it is ${needed} pixels wide`);
    found.push(...here.map((each) => `in ${width} pixels: ${each}`));
    await picture(page, `${name}-${width}`);
  }
  await page.setViewportSize(before);
  return found;
}

export async function pixelsOf(page) {
  return PNG.sync.read(await page.screenshot());
}

function linear(value) {
  return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
}

/** Mean of a picture, white being 1. */
export function luminanceOf({data}) {
  let sum = 0;
  for (let at = 0; at < data.length; at += 4) {
    sum += 0.2126 * linear(data[at] / 255) + 0.7152 * linear(data[at + 1] / 255) + 0.0722 * linear(data[at + 2] / 255);
  }
  return sum / (data.length / 4);
}

/** Keeps a picture of a page, where WEFT_PICTURES names a folder for them. */
export async function picture(page, name) {
  if (process.env.WEFT_PICTURES) await page.screenshot({path: path.join(process.env.WEFT_PICTURES, `${name}.png`)});
}
