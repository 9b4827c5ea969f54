import { defineConfig } from '@playwright/test';

// The real program, the real page, Debian's Chromium. One after the other: the program uses all cores.
export default defineConfig({
  testDir: 'tests',
  workers: 1,
  fullyParallel: false,
  timeout: 180_000, // on a machine that others keep busy; what fails once and then passes is told as flaky
  retries: 1,
  expect: { timeout: 30_000 },
  reporter: [['list']],
  outputDir: 'test-results',
  use: {
    // Small, so that pictures converge soon, and wide enough for both panels.
    viewport: { width: 1120, height: 520 },
    colorScheme: 'dark',
    launchOptions: { executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: ['--no-sandbox', '--enable-unsafe-swiftshader'] },
  },
});
