// SPDX-License-Identifier: Apache-2.0
import {build, defineConfig, type Plugin, type Rollup} from 'vite';

const daemon = process.env.WEFT_DAEMON ?? 'http://127.0.0.1:8470';

/** A screen's file is called as its folder. */
function nameOf(module: string | null): string {
  return module?.match(/screens\/(\w+)\/screen/)?.[1] ?? '[name]';
}

/** Draws a report, which carries it (report/page.h): one file with its style. */
const report: Plugin = {
  name: 'report',
  apply: 'build',
  async generateBundle() {
    const made = await build({
      configFile: false,
      logLevel: 'warn',
      build: {target: 'es2022', write: false, rollupOptions: {input: 'src/report/main.tsx', output: {format: 'iife'}}},
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
    rollupOptions: {
      output: {
        chunkFileNames: ({facadeModuleId}) => `assets/${nameOf(facadeModuleId)}-[hash].js`,
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
