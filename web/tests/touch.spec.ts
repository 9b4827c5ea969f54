// Fingers on a tablet: one turns, two move and zoom, a tap selects. And where the pointer is, the picture grows first.
import { converged, expect, growTo, pixels, selected, test, visit } from './program';
import type { Page } from '@playwright/test';

test.use({ hasTouch: true, viewport: { width: 820, height: 1180 } });

type Finger = { x: number; y: number };
type Camera = { position: number[]; target: number[] };

// The cameras that the page tells, as they come.
function cameras(page: Page): Camera[] {
  const told: Camera[] = [];
  page.on('websocket', (socket) => socket.on('framesent', ({ payload }) => {
    const { look } = JSON.parse(String(payload)) as { look?: Camera };
    if (look) told.push(look);
  }));
  return told;
}

async function touch(page: Page, paths: Finger[][]): Promise<void> {
  const client = await page.context().newCDPSession(page);
  const send = (type: 'touchStart' | 'touchMove' | 'touchEnd', fingers: Finger[]) => client.send('Input.dispatchTouchEvent', { type, touchPoints: fingers.map((finger, id) => ({ ...finger, id })) });
  for (let n = 1; n <= paths.length; n++) await send('touchStart', paths.slice(0, n).map((path) => path[0]));
  for (let step = 1; step < paths[0].length; step++) {
    await send('touchMove', paths.map((path) => path[step]));
    await page.waitForTimeout(20);
  }
  await send('touchEnd', []);
}

const between = (a: Finger, b: Finger, steps = 8) => Array.from({ length: steps + 1 }, (_, i) => ({ x: a.x + ((b.x - a.x) * i) / steps, y: a.y + ((b.y - a.y) * i) / steps }));
const distance = ({ position, target }: Camera) => Math.hypot(...position.map((x, i) => x - target[i]));
const direction = (camera: Camera) => camera.target.map((x, i) => (x - camera.position[i]) / distance(camera));
const angle = (a: Camera, b: Camera) => Math.acos(Math.min(1, direction(a).reduce((sum, x, i) => sum + x * direction(b)[i], 0)));

test('one finger turns, two fingers zoom and move, a tap selects', async ({ page, start }) => {
  const told = cameras(page);
  await visit(page, await start());
  await growTo(page, 'visible');
  await converged(page);
  const middle = { x: 410, y: 560 };

  // A first small turn tells where the view is.
  await touch(page, [between(middle, { x: middle.x + 12, y: middle.y })]);
  await expect.poll(() => told.length).toBeGreaterThan(0);
  await page.waitForTimeout(500);
  const before = told[told.length - 1];
  const seen = await pixels(page);
  await touch(page, [between(middle, { x: middle.x + 120, y: middle.y })]);
  await page.waitForTimeout(500);
  const turned = told[told.length - 1];
  expect(angle(before, turned)).toBeGreaterThan(0.2);
  expect(distance(turned) / distance(before)).toBeCloseTo(1, 3);
  await converged(page, seen);

  await touch(page, [between({ x: 370, y: 560 }, { x: 290, y: 560 }), between({ x: 450, y: 560 }, { x: 530, y: 560 })]);
  await page.waitForTimeout(500);
  const near = told[told.length - 1];
  const stride = (a: Camera, b: Camera) => Math.hypot(...a.position.map((x, i) => x - b.position[i]));
  expect(angle(turned, near), 'a pinch turns nothing').toBeLessThan(0.02);
  expect(near.position.reduce((sum, x, i) => sum + (x - turned.position[i]) * direction(turned)[i], 0), 'it comes nearer').toBeGreaterThan(0.1 * distance(turned));

  await touch(page, [between({ x: 380, y: 560 }, { x: 380, y: 660 }), between({ x: 440, y: 560 }, { x: 440, y: 660 })]);
  await page.waitForTimeout(500);
  const moved = told[told.length - 1];
  expect(angle(near, moved), 'two fingers turn nothing').toBeLessThan(0.02);
  expect(stride(near, moved)).toBeGreaterThan(0.01 * distance(near));
  await expect(selected(page), 'two fingers select nothing').toHaveCount(0);
});

test('the program is told where the pointer is', async ({ page, start }) => {
  const areas: unknown[] = [];
  page.on('websocket', (socket) => socket.on('framesent', ({ payload }) => {
    const message = JSON.parse(String(payload)) as { attend?: unknown };
    if ('attend' in message) areas.push(message.attend);
  }));
  await visit(page, await start());
  await page.mouse.move(300, 500);
  await page.mouse.move(400, 600, { steps: 3 });
  await expect.poll(() => areas.at(-1)).toEqual({ x: 304, y: 504, width: 192, height: 192 });
  await page.mouse.move(20, 20); // onto the bar
  await expect.poll(() => areas.at(-1)).toBeNull();
});
