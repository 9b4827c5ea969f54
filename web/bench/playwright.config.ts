import { defineConfig } from '@playwright/test';
import tests from '../playwright.config';

export default defineConfig({ ...tests, testDir: '.', testMatch: ['latency.ts', 'screenshots.ts'], timeout: 300_000, outputDir: '../test-results', use: { ...tests.use, viewport: { width: 1280, height: 720 } } });
