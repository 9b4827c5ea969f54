import react from '@vitejs/plugin-react';
import { defineConfig } from 'vite';

// Relative addresses: the program serves the files of dist/ from its own memory, under whatever address it has.
// Nothing is inlined as data: or script text, so that the strict content security policy of the program holds.
export default defineConfig({
  base: './',
  plugins: [react()],
  build: { target: 'es2022', assetsInlineLimit: 0, chunkSizeWarningLimit: 2000, modulePreload: { polyfill: false } },
  server: { proxy: { '/socket': { target: 'ws://127.0.0.1:8080', ws: true }, '/upload': 'http://127.0.0.1:8080', '/export': 'http://127.0.0.1:8080' } },
});
