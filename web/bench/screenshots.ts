// The pictures of docs/viewer.md but that of the start page, which has a folder in it: a small assembly in the materials of the catalogue, in the page as it is now.
//
//     npm run screenshots
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { converged, expect, folder, growTo, model, run, test, visit } from '../tests/program';
import type { Page } from '@playwright/test';

const root = resolve(dirname(fileURLToPath(import.meta.url)), '../..');
const still = async (page: Page, name: string) => {
  await converged(page);
  await page.waitForTimeout(800); // of what fades in or out
  await page.screenshot({ path: join(root, 'docs/images/viewer', name) });
};

test('the view', async ({ page, start }) => {
  const scene = join(folder, 'as1.json');
  run('edit', model, join(root, 'scenes/catalogue/as1.jsonl'), '--level', 'visible', '--size', '64x48', '-q', '-o', scene);
  await page.emulateMedia({ colorScheme: 'dark' });
  await visit(page, await start([scene]));
  await growTo(page, 'edges');

  await page.getByRole('treeitem', { name: 'plate' }).first().click();
  await page.keyboard.press('m');
  await still(page, 'view_dark.png');

  await page.keyboard.press('s');
  await page.getByTestId('tab-lights').click();
  await page.getByRole('button', { name: 'Add a light' }).click();
  await page.getByRole('menuitem', { name: /^Spot/ }).click();
  await expect(page.getByRole('slider', { name: 'Cone', exact: true })).toHaveCount(1);
  await still(page, 'lights_dark.png');

  await page.getByTestId('undo').click();
  await page.mouse.click(640, 470);
  await page.getByTestId('tab-material').click();
  await page.getByTestId('slider-roughness').getByRole('slider').press('ArrowRight');
  await page.getByTestId('tab-numbers').click();
  await page.getByTestId('replay').click();
  await still(page, 'numbers_dark.png');

  await page.keyboard.press('Escape');
  await page.emulateMedia({ colorScheme: 'light' });
  await page.getByTestId('tab-material').click();
  await page.mouse.move(640, 600);
  await still(page, 'materials_light.png');
});
