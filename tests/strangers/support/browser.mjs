// SPDX-License-Identifier: Apache-2.0
// Pages in Debian's Chromium, served with the two headers that shared memory asks for.
import fs from 'node:fs';
import http from 'node:http';
import path from 'node:path';
import {chromium} from 'playwright-core';
import {here} from './programs.mjs';

const program = process.env.CHROMIUM ?? '/usr/bin/chromium-headless-shell';
const flags = [
  '--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--force-color-profile=srgb', '--disable-quic',
  '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync',
];
const types = {'.js': 'text/javascript', '.mjs': 'text/javascript', '.wasm': 'application/wasm', '.png': 'image/png', '.html': 'text/html'};
const imports = JSON.stringify({imports: {
  three: '/node_modules/three/build/three.module.js',
  'three/webgpu': '/node_modules/three/build/three.webgpu.js',
  'three/tsl': '/node_modules/three/build/three.tsl.js',
  'three/addons/': '/node_modules/three/examples/jsm/',
}});

export const whyNoBrowser = fs.existsSync(program) ? '' : `there is no ${program} (Debian's chromium-headless-shell)`;

export class Browser {
  #folders = [];
  #html = '';

  static async open() {
    const self = new Browser();
    self.server = http.createServer((request, response) => self.#answer(request, response));
    await new Promise((ready) => self.server.listen(0, '127.0.0.1', ready));
    self.chromium = await chromium.launch({executablePath: program, args: flags});
    return self;
  }

  /** The address of a file; files of its folder stand beside it. */
  address(file) {
    const folder = path.dirname(path.resolve(file));
    if (!this.#folders.includes(folder)) this.#folders.push(folder);
    return `/files/${this.#folders.indexOf(folder)}/${encodeURIComponent(path.basename(file))}`;
  }

  #fileOf(address) {
    const parts = decodeURIComponent(address).split('/').filter(Boolean);
    if (parts.includes('..')) return null;
    if (parts[0] === 'node_modules') return path.join(here, ...parts);
    if (parts[0] === 'files' && this.#folders[parts[1]]) return path.join(this.#folders[parts[1]], ...parts.slice(2));
    return null;
  }

  #answer(request, response) {
    const address = request.url.split('?')[0];
    response.setHeader('Cross-Origin-Opener-Policy', 'same-origin');
    response.setHeader('Cross-Origin-Embedder-Policy', 'require-corp');
    if (address === '/page.html') return response.setHeader('Content-Type', 'text/html').end(this.#html);
    const file = this.#fileOf(address);
    if (!file || !fs.existsSync(file) || fs.statSync(file).isDirectory()) return response.writeHead(404).end();
    response.setHeader('Content-Type', types[path.extname(file)] ?? 'application/octet-stream');
    return fs.createReadStream(file).pipe(response);
  }

  /**
   * Runs a module in a page of its own: `script` defines `async function work(tasks)`; returns what work gives and the
   * words of the console. `head` is HTML before it.
   */
  async run(script, tasks, {head = '', seconds = 90} = {}) {
    this.#html = `<!doctype html><script type="importmap">${imports}</script>${head}<script type="module">
${script}
work(${JSON.stringify(tasks)}).then((result) => { window.result = {result}; }, (error) => { window.result = {error: String(error?.stack ?? error)}; });
</script>`;
    const page = await this.chromium.newPage({viewport: {width: 600, height: 300}});
    const said = [];
    page.on('console', (message) => said.push(message.text()));
    page.on('pageerror', (error) => said.push(error.message));
    try {
      await page.goto(`http://127.0.0.1:${this.server.address().port}/page.html`);
      await page.waitForFunction('window.result !== undefined', null, {timeout: seconds * 1000});
      const {result, error} = await page.evaluate('window.result');
      if (error) throw new Error(`${error}\n${said.join('\n')}`);
      return {result, said};
    } catch (error) {
      error.message += `\n${said.slice(0, 20).join('\n')}`;
      throw error;
    } finally {
      await page.close();
    }
  }

  async close() {
    await this.chromium.close();
    this.server.close();
  }
}
