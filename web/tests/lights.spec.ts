// Lights are shaped by their handles in the picture.
import { converged, expect, growTo, pixels, test, visit } from './program';
import type { Page } from '@playwright/test';

const addLight = async (page: Page, kind: RegExp) => {
  await page.getByTestId('tab-lights').click();
  await page.getByRole('button', { name: 'Add a light' }).click();
  await page.getByRole('menuitem', { name: kind }).click();
};

const handle = (page: Page, name: string) => page.getByTestId('stage').getByRole('slider', { name, exact: true });
const valueOf = async (page: Page, name: string) => Number(await handle(page, name).getAttribute('aria-valuenow'));

async function drag(page: Page, name: string, x: number, y: number): Promise<void> {
  const box = await handle(page, name).boundingBox();
  if (!box) throw new Error(`the handle ${name} is not in the picture`);
  const at = { x: box.x + box.width / 2, y: box.y + box.height / 2 };
  await page.mouse.move(at.x, at.y);
  await page.mouse.down();
  await page.mouse.move(at.x + x, at.y + y, { steps: 6 });
  await page.mouse.up();
}

test('the cones of a spot are dragged in the picture; one drag is one undo', async ({ page, start }) => {
  await visit(page, await start());
  await growTo(page, 'visible');
  await addLight(page, /^Spot/);
  await expect(handle(page, 'Cone')).toHaveAttribute('aria-valuenow', '22');
  await converged(page);
  const lit = await pixels(page);
  const transform = await page.locator('.picture').evaluate((canvas) => (canvas as HTMLElement).style.transform);

  const inner = await handle(page, 'Full light within the cone').boundingBox();
  const outer = await handle(page, 'Cone').boundingBox();
  if (!inner || !outer) throw new Error('the handles are not in the picture');
  const along = { x: Math.sign(outer.x - inner.x), y: Math.sign(outer.y - inner.y) };
  await drag(page, 'Cone', 40 * along.x, 40 * along.y);
  await expect.poll(() => valueOf(page, 'Cone')).toBeGreaterThan(24);
  await converged(page, lit);
  await expect(page.getByRole('textbox', { name: 'Outer angle' })).toHaveValue(new RegExp(`^${(await valueOf(page, 'Cone')).toString().replace('.', '\\.').slice(0, 4)}`));
  await page.getByTestId('undo').click();
  await expect(handle(page, 'Cone')).toHaveAttribute('aria-valuenow', '22');
  await expect.poll(() => pixels(page)).toBe(lit);
  expect(await page.locator('.picture').evaluate((canvas) => (canvas as HTMLElement).style.transform), 'the view has stayed').toBe(transform);

  // A cone that gets narrower than its full light takes that with it.
  await drag(page, 'Cone', -400 * along.x, -400 * along.y);
  await expect.poll(() => valueOf(page, 'Cone')).toBeLessThan(12);
  await expect.poll(async () => (await valueOf(page, 'Full light within the cone')) - (await valueOf(page, 'Cone'))).toBe(0);
});

test('the size of a light, which makes shadows soft, is stepped by keys and dragged', async ({ page, start }) => {
  await visit(page, await start());
  await growTo(page, 'shadows');
  await addLight(page, /^Rectangle/);
  for (const [axis, value] of [['x', '90'], ['y', '85'], ['z', '-20']]) { // into sight
    const box = page.getByLabel(new RegExp(`^Position, ${axis}`));
    const place = () => page.locator('.light-mark[aria-pressed=true]').getAttribute('style');
    const before = await place();
    await box.fill(value);
    await box.press('Enter');
    await expect.poll(place).not.toBe(before);
  }
  const width = handle(page, 'Width');
  await expect(width).toBeVisible();
  await converged(page);
  const before = await valueOf(page, 'Width');
  const lit = await pixels(page);
  await width.focus();
  await page.keyboard.press('ArrowRight');
  await expect.poll(() => valueOf(page, 'Width')).toBeGreaterThan(before);
  await converged(page, lit);
  await page.keyboard.press('Control+z');
  await expect.poll(() => valueOf(page, 'Width')).toBeCloseTo(before, 6);
  const height = await valueOf(page, 'Height');
  await drag(page, 'Height', 3, -30);
  await expect.poll(() => valueOf(page, 'Height')).not.toBeCloseTo(height, 3);
});

for (const [view, key] of [['the back', '2'], ['the left', '4'], ['above', '5'], ['the corner', '0']]) {
  test(`a new light stands where the panels leave the picture free, seen from ${view}`, async ({ page, start }) => {
    await visit(page, await start());
    await growTo(page, 'visible');
    await page.getByTestId('stage').focus();
    await page.keyboard.press(key);
    await page.waitForTimeout(1000); // the turn comes to its end
    for (const kind of [/^Spot/, /^Point/]) {
      await addLight(page, kind);
      const mark = page.locator('.light-mark[aria-pressed=true]');
      await expect(mark).toBeVisible();
      const box = await mark.boundingBox();
      if (!box) throw new Error('the mark is nowhere');
      const at = { x: box.x + box.width / 2, y: box.y + box.height / 2 };
      expect(await page.evaluate(({ x, y }) => document.elementFromPoint(x, y)?.className, at), 'what the pointer meets there').toBe('light-mark');
      await page.mouse.click(550, 480); // nothing is chosen
    }
  });
}
