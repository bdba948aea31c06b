// SPDX-License-Identifier: Apache-2.0
import {defineConfig} from 'vite';

const daemon = process.env.WEFT_DAEMON ?? 'http://127.0.0.1:8470';

/** A screen's file is called as its folder. */
function nameOf(module: string | null): string {
  return module?.match(/screens\/(\w+)\/screen/)?.[1] ?? '[name]';
}

export default defineConfig({
  base: '/',
  // Neither data: addresses nor a script of vite's own: the daemon's policy refuses both.
  build: {
    target: 'es2022',
    assetsInlineLimit: 0,
    modulePreload: {polyfill: false},
    reportCompressedSize: false,
    sourcemap: false,
    rollupOptions: {output: {chunkFileNames: ({facadeModuleId}) => `assets/${nameOf(facadeModuleId)}-[hash].js`}},
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
