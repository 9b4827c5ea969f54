// The program as users run it: `crescente view`, ended after each test.
import { spawn, spawnSync, type ChildProcess } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { test as base, expect, type Page } from '@playwright/test';

const root = resolve(dirname(fileURLToPath(import.meta.url)), '../..');
export const crescente = process.env.CRESCENTE ?? join(root, 'build/release/bin/crescente');
export const model = join(root, 'scenes/as1-oc-214.stp');

export class Program {
  private constructor(private readonly child: ChildProcess, readonly address: string) {}

  static start(options: string[]): Promise<Program> {
    const child = spawn(crescente, ['view', '--no-browser', ...options], { stdio: ['ignore', 'pipe', 'pipe'], env: { ...process.env, TMPDIR: state, XDG_STATE_HOME: state, XDG_CACHE_HOME: state, XDG_DATA_HOME: state } });
    return new Promise((found, failed) => {
      let said = '';
      child.stdout?.on('data', (data) => {
        said += String(data);
        const address = /http:\/\/\S+/.exec(said)?.[0];
        if (address) found(new Program(child, address));
      });
      let complaint = '';
      child.stderr?.on('data', (data) => (complaint += String(data)));
      child.on('exit', (code, signal) => {
        failed(new Error(`crescente view ended with ${code ?? signal}: ${complaint}`));
      });
    });
  }

  // As a crash or a lost machine would: nothing is said to the page.
  kill(): Promise<void> {
    return new Promise((ended) => {
      if (this.child.exitCode !== null || this.child.signalCode !== null) return ended();
      this.child.once('exit', () => ended());
      this.child.kill('SIGKILL');
    });
  }
}

const state = mkdtempSync(join(tmpdir(), 'crescente-viewer-'));
process.on('exit', () => rmSync(state, { recursive: true, force: true }));

// A folder of the test's own, gone afterwards.
export const folder = state;

export function run(...options: string[]): void {
  const done = spawnSync(crescente, options, { encoding: 'utf8' });
  if (done.status !== 0) throw new Error(`crescente ${options.join(' ')}: ${done.stderr}`);
}

type Fixtures = { start(options?: string[]): Promise<Program> };

export const test = base.extend<Fixtures>({
  start: async ({ page }, use) => {
    const programs: Program[] = [];
    const complaints: string[] = [];
    page.on('pageerror', (error) => complaints.push(String(error)));
    page.on('console', (message) => {
      if (/Content Security Policy|Refused to/.test(message.text())) complaints.push(message.text());
    });
    await use(async (options = [model]) => {
      const program = await Program.start(options);
      programs.push(program);
      return program;
    });
    await Promise.all(programs.map((program) => program.kill()));
    expect(complaints, 'nothing on the page fails, and the content security policy forbids nothing that it needs').toEqual([]);
  },
});

export { expect };

// Opens the page of the program, and waits for the first picture.
export async function visit(page: Page, program: Program): Promise<void> {
  await page.goto(program.address);
  await expect(page.getByTestId('stage')).toHaveAttribute('data-frames', /\d/);
}

export async function growTo(page: Page, level: string): Promise<void> {
  await page.getByTestId('until').click();
  await page.getByRole('menuitem', { name: new RegExp(`^${level}`, 'i') }).click();
  await expect(page.getByRole('menu')).toHaveCount(0); // it covers part of the picture
}

// Finished, and what is shown is without loss; not before other pixels are there than those of `before`.
export async function converged(page: Page, before?: number): Promise<void> {
  if (before !== undefined) await expect.poll(() => pixels(page), { timeout: 45_000 }).not.toBe(before);
  await expect(page.getByTestId('status')).toHaveAttribute('data-state', 'finished', { timeout: 45_000 });
  await expect(page.getByTestId('stage')).toHaveAttribute('data-converged', 'true');
}

// A number that stands for the pixels that the page has drawn.
export function pixels(page: Page): Promise<number> {
  return page.evaluate(() => {
    const canvas = document.querySelector<HTMLCanvasElement>('.picture');
    const data = canvas?.getContext('2d')?.getImageData(0, 0, canvas.width, canvas.height).data ?? [];
    let sum = 0;
    for (let i = 0; i < data.length; i++) sum = (sum * 31 + data[i]) | 0;
    return sum;
  });
}

// The pixels themselves, as rgba.
export async function picture(page: Page): Promise<{ width: number; height: number; data: Buffer }> {
  const { width, height, text } = await page.evaluate(() => {
    const canvas = document.querySelector<HTMLCanvasElement>('.picture');
    const data = canvas?.getContext('2d')?.getImageData(0, 0, canvas.width, canvas.height).data ?? new Uint8ClampedArray();
    let text = '';
    for (let i = 0; i < data.length; i += 0x8000) text += String.fromCharCode(...data.subarray(i, i + 0x8000));
    return { width: canvas?.width ?? 0, height: canvas?.height ?? 0, text: btoa(text) };
  });
  return { width, height, data: Buffer.from(text, 'base64') };
}

// Keys pressed while the picture has the focus.
export const press = async (page: Page, keys: string) => {
  await page.getByTestId('stage').focus();
  await page.keyboard.press(keys);
};

export const rested = (page: Page) => page.waitForTimeout(1000); // of a turn of the view

export type Look = { position: number[]; target: number[]; up: number[]; projection: string; field_of_view: number; height: number };

// The cameras that the page tells, as they come.
export function cameras(page: Page): Look[] {
  const told: Look[] = [];
  page.on('websocket', (socket) => socket.on('framesent', ({ payload }) => {
    const { look } = JSON.parse(String(payload)) as { look?: Look };
    if (look) told.push(look);
  }));
  return told;
}

// Until the view has come to rest.
export async function settled(page: Page, told: unknown[]): Promise<void> {
  for (let before = -1; before !== told.length; ) {
    before = told.length;
    await rested(page);
  }
}

// A place of the page on the plate of the model, as it is framed at first.
export const plate = { x: 545, y: 300 };

export const selected = (page: Page) => page.locator('[role=treeitem][aria-selected=true]');

export async function selectPart(page: Page): Promise<void> {
  await page.mouse.click(plate.x, plate.y);
  await expect(selected(page)).toHaveCount(1);
}

// A place at which the pointer is on the upright arrow of the handles, which stand in the middle of the part.
export async function findHandle(page: Page): Promise<{ x: number; y: number }> {
  for (let y = 200; y < 300; y += 10) {
    for (let x = 500; x < 620; x += 5) {
      await page.mouse.move(x, y);
      if ((await page.getByTestId('stage').getAttribute('data-handle')) === 'Y') return { x, y };
    }
  }
  throw new Error('the handles are nowhere to be seen');
}
