// SPDX-License-Identifier: Apache-2.0
import {build, defineConfig, type Plugin, type Rollup} from 'vite';

const daemon = process.env.WEFT_DAEMON ?? 'http://127.0.0.1:8470';

/** What is shown together is packed together, which is an eleventh smaller; what several of these need is in the first file. */
const packs: readonly (readonly [name: string, holds: RegExp])[] = [
  ['desk', /\/screens\/desk\//],
  ['looks', /\/(gl|screens\/(viewer|material|finish))\/(?!sight|job_line)/],
  ['rooms', /\/screens\/(sessions|batches|calibrate|doctor|tour|jobs\/job(s_screen|_row))/],
  ['virtual', /\/virtual_panel/],
];

function fileOf(module: string): string {
  return packs.find(([, holds]) => holds.test(module))?.[0] ?? 'index';
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
    terserOptions: {ecma: 2020, module: true, compress: {ecma: 2020, passes: 3, pure_getters: true, unsafe_arrows: true, hoist_funs: true}},
    rollupOptions: {
      output: {
        chunkFileNames: 'assets/[name]-[hash].js',
        manualChunks: fileOf,
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
