// The pointer on the picture, and the page without a pointer.
import { cameras, converged, expect, findHandle, growTo, pixels, plate, press, selected, selectPart, settled, test, visit, type Look, type Program } from './program';
import type { Page } from '@playwright/test';

const bracket = { x: 690, y: 250 };

type Vec = number[];
const minus = (a: Vec, b: Vec) => a.map((x, i) => x - b[i]);
const dot = (a: Vec, b: Vec) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const cross = (a: Vec, b: Vec) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a: Vec) => a.map((x) => x / Math.hypot(...a));
const distance = ({ position, target }: Look) => Math.hypot(...minus(position, target));

// Where a place of the page looks to.
function ray({ position, target, up, field_of_view }: Look, { x, y }: { x: number; y: number }, { width, height }: { width: number; height: number }): Vec {
  const forward = unit(minus(target, position));
  const right = unit(cross(forward, up));
  const top = cross(right, forward);
  const half = Math.tan((field_of_view * Math.PI) / 360);
  const across = ((2 * x) / width - 1) * half * (width / height);
  const above = (1 - (2 * y) / height) * half;
  return unit(forward.map((f, i) => f + across * right[i] + above * top[i]));
}

const marked = (page: Page) => page.locator('[role=treeitem][data-hovered=true]');

test('the pointer marks the part that it is on; a double click goes to it, F back to everything, the wheel where the pointer is', async ({ page, start }) => {
  const told = cameras(page);
  await visit(page, await start());
  await growTo(page, 'visible');
  await converged(page);
  await page.mouse.move(plate.x, plate.y);
  await expect(marked(page)).toContainText('plate');
  await page.getByTestId('assembly').getByPlaceholder('Search').fill('l-bracket_');
  await page.mouse.move(bracket.x, bracket.y);
  await expect(marked(page)).toContainText('l-bracket');
  await page.getByTestId('assembly').getByPlaceholder('Search').fill('');
  await page.mouse.move(100, 30); // on the bar
  await expect(marked(page)).toHaveCount(0);

  await page.mouse.dblclick(bracket.x, bracket.y);
  await expect(selected(page)).toContainText('l-bracket');
  await expect.poll(() => told.length).toBeGreaterThan(0);
  await settled(page, told);
  const part = told[told.length - 1];
  await page.keyboard.press('Escape');
  await press(page, 'f');
  await expect.poll(() => distance(told[told.length - 1])).toBeGreaterThan(1.1 * distance(part));
  await settled(page, told);
  const whole = told[told.length - 1];

  await page.mouse.move(bracket.x, bracket.y);
  for (let i = 0; i < 3; i++) await page.mouse.wheel(0, -240);
  await expect.poll(() => distance(told[told.length - 1])).toBeLessThan(0.8 * distance(whole));
  await settled(page, told);
  const near = told[told.length - 1];
  const size = await page.getByTestId('stage').evaluate(({ clientWidth, clientHeight }) => ({ width: clientWidth, height: clientHeight }));
  const way = unit(minus(near.position, whole.position));
  expect(dot(way, ray(whole, bracket, size)), 'the way of the camera is along what the pointer is on').toBeGreaterThan(0.9999);
  expect(dot(ray(near, bracket, size), ray(whole, bracket, size))).toBeGreaterThan(0.999999);
});

// The box that has it, of the plate, which is selected.
async function heightOfPlate(page: Page, program: Program) {
  await visit(page, program);
  await growTo(page, 'visible');
  await selectPart(page);
  await page.getByTestId('tab-object').click();
  return page.getByLabel(/^Position, y/);
}

test('handles go in round steps when they snap', async ({ page, start }) => {
  const height = await heightOfPlate(page, await start());
  await press(page, 'm');
  await press(page, 'n');
  const { x, y } = await findHandle(page);
  const heights = new Set<number>();
  await page.mouse.down();
  for (let i = 1; i <= 40; i++) {
    await page.mouse.move(x, y - 2 * i);
    await page.waitForTimeout(60);
    heights.add(Number.parseFloat(await height.inputValue()));
  }
  await page.mouse.up();
  expect(heights.size).toBeGreaterThan(4);
  for (const one of heights) expect(one % 5, `${one} mm is a step of 5`).toBeCloseTo(0, 3);
});

test('numbers of any size stand in their boxes as they are', async ({ page, start }) => {
  const height = await heightOfPlate(page, await start());
  for (const [typed, shown] of [['0.00002', 0.00002], ['12345678', 12350000], ['-0.5', -0.5]] as const) {
    await height.fill(typed);
    await height.press('Enter');
    await page.waitForTimeout(300);
    await height.focus();
    await height.blur();
    await expect.poll(async () => Number.parseFloat(await height.inputValue())).toBe(shown);
  }
});

test('without a pointer: a part is found, chosen, and made of another stuff', async ({ page, start }) => {
  await visit(page, await start());
  await growTo(page, 'visible');
  await converged(page);
  const before = await pixels(page);
  const focused = (selector: string) => page.evaluate((wanted) => document.activeElement?.matches(wanted) ?? false, selector);
  const tabTo = async (selector: string) => {
    for (let i = 0; i < 80 && !(await focused(selector)); i++) await page.keyboard.press('Tab');
    expect(await focused(selector), selector).toBe(true);
  };
  await page.evaluate(() => (document.activeElement as HTMLElement | null)?.blur());
  await tabTo('[role=tree], [role=tree] *');
  for (let i = 0; i < 8 && (await selected(page).filter({ hasText: 'plate' }).count()) === 0; i++) {
    await page.keyboard.press('ArrowDown');
    await page.waitForTimeout(200);
  }
  await expect(selected(page)).toContainText('plate');
  await tabTo('[data-testid=slider-roughness] *');
  await page.keyboard.press('End');
  await converged(page, before);
  while (await page.getByTestId('undo').isEnabled()) {
    await page.keyboard.press('Control+z');
    await page.waitForTimeout(200);
  }
  await expect.poll(() => pixels(page)).toBe(before);
});
