// Edits that follow each other quickly, or of which each has something of the one before.
import { expect, growTo, test, visit } from './program';
import type { Page } from '@playwright/test';

// The way to the program is long: what the page says arrives late.
const longWay = () => {
  const send = WebSocket.prototype.send;
  WebSocket.prototype.send = function (data) {
    setTimeout(() => this.readyState === WebSocket.OPEN && send.call(this, data), 400);
  };
};

const fill = async (page: Page, label: RegExp, value: string) => {
  const box = page.getByLabel(label);
  await box.fill(value);
  await box.press('Enter');
};

test('boxes of one vector that are filled in quickly all count', async ({ page, start }) => {
  await page.addInitScript(longWay);
  await visit(page, await start());
  await growTo(page, 'visible');
  await page.getByRole('treeitem', { name: 'plate' }).click();
  await page.getByTestId('tab-object').click();
  for (const [axis, value] of [['x', '11'], ['y', '22'], ['z', '33']]) await fill(page, new RegExp(`^Position, ${axis}`), value);
  await fill(page, /^Rotation, y/, '15');
  await expect(page.getByLabel(/^Rotation, y/)).toHaveValue('15');
  await page.getByTestId('tab-lights').click();
  await page.getByTestId('lights').getByRole('listitem').first().getByRole('button').first().click();
  for (const [axis, value] of [['x', '0.5'], ['y', '-0.7'], ['z', '0.1']]) await fill(page, new RegExp(`^Direction, ${axis}`), value);
  await expect(page.getByTestId('undo')).toBeEnabled();
  await page.waitForTimeout(4000); // whatever answers there are have come
  for (const [axis, value] of [['x', '0.5'], ['y', '-0.7'], ['z', '0.1']]) await expect(page.getByLabel(new RegExp(`^Direction, ${axis}`))).toHaveValue(value);
  await page.getByRole('treeitem', { name: 'plate' }).click();
  await page.getByTestId('tab-object').click();
  await expect(page.getByLabel(/^Rotation, y/)).toHaveValue('15');
  const at = async (axis: string) => Number(await page.getByLabel(new RegExp(`^Position, ${axis}`)).inputValue());
  expect(Math.hypot((await at('x')) - 11, (await at('y')) - 22, (await at('z')) - 33), 'it turned about its middle, from where it was put').toBeLessThan(40);
});
