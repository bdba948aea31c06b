// SPDX-License-Identifier: Apache-2.0
import path from 'node:path';
import {build, defineConfig, type Plugin, type Rollup} from 'vite';

const daemon = process.env.WEFT_DAEMON ?? 'http://127.0.0.1:8470';

/** A screen's files are called as its folder: their names stand in what is loaded first. */
function nameOf(file: string): string {
  return path.parse(file).name.replace('_screen', '');
}

/** Draws a report, which carries it (report/page.h): one file with its style. */
const report: Plugin = {
  name: 'report',
  apply: 'build',
  async generateBundle() {
    const made = await build({
      configFile: false,
      logLevel: 'warn',
      build: {target: 'es2022', write: false, rollupOptions: {input: 'src/report/draw_report.tsx', output: {format: 'iife'}}},
    });
    for (const file of (made as Rollup.RollupOutput).output) {
      if (file.type === 'chunk') this.emitFile({type: 'asset', fileName: 'report.js', source: file.code});
    }
  },
};

export default defineConfig({
  plugins: [report],
  base: '/',
  // Neither data: addresses nor a script of vite's own: the daemon's policy refuses both.
  build: {
    target: 'es2022',
    assetsInlineLimit: 0,
    modulePreload: {polyfill: false},
    reportCompressedSize: false,
    sourcemap: false,
    minify: 'terser',  // a sixtieth smaller than esbuild makes it
    terserOptions: {ecma: 2020, module: true, compress: {ecma: 2020, passes: 3, pure_getters: true, unsafe_arrows: true}},
    rollupOptions: {
      output: {
        chunkFileNames: ({name}) => `assets/${nameOf(name)}-[hash].js`,
        assetFileNames: ({names: [name = '']}) => `assets/${nameOf(name)}-[hash][extname]`,
        experimentalMinChunkSize: 1000,  // bytes: asking for less takes longer than it does
      },
    },
  },
  // The daemon takes changes from its own origin alone, so that of the development server is left out.
  server: {
    host: '127.0.0.1',
    proxy: {
      '/api': {
        target: daemon,
        changeOrigin: true,
        configure: (proxy) => proxy.on('proxyReq', (request) => request.removeHeader('origin')),
      },
    },
  },
});
