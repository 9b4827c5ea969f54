// The page's main states, light and dark, by the rules of WCAG 2.1 A and AA as far as a program can check them (axe-core).
import { AxeBuilder } from '@axe-core/playwright';
import { join } from 'node:path';
import { expect, growTo, model, test, visit } from './program';
import type { Page } from '@playwright/test';

async function check(page: Page, state: string, except: string[] = []): Promise<void> {
  const { violations } = await new AxeBuilder({ page }).disableRules(except).withTags(['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa']).analyze();
  const told = violations.flatMap((one) => one.nodes.map((node) => `${one.id}: ${node.target.join(' ')}: ${node.failureSummary?.split('\n')[1]?.trim()}`));
  expect.soft(told, state).toEqual([]);
}

for (const colorScheme of ['dark', 'light'] as const) {
  test(`the view, its panels and its dialogs are accessible, ${colorScheme}`, async ({ page, start }) => {
    test.slow();
    await page.emulateMedia({ colorScheme });
    await visit(page, await start());
    await growTo(page, 'visible');
    await check(page, 'the view');
    await page.getByRole('treeitem', { name: 'plate' }).click();
    for (const tab of ['material', 'object', 'lights', 'studio', 'cameras', 'numbers']) {
      await page.getByTestId(`tab-${tab}`).click();
      await page.waitForTimeout(300); // colours have come to rest
      await check(page, `tab ${tab}`);
    }
    await page.getByTestId('tab-lights').click();
    await page.getByTestId('lights').getByRole('listitem').first().getByRole('button').first().click();
    await check(page, 'a light is chosen');
    await page.getByTestId('file-menu').click();
    await page.waitForTimeout(300);
    await check(page, 'the menu of files', ['aria-required-children']); // Mantine's anchor of the focus is among its items
    await page.keyboard.press('Escape');
    for (const open of ['Export picture', 'Keys and pointer']) {
      await page.getByRole('button', { name: open }).click();
      await expect(page.getByRole('dialog')).toBeVisible();
      await page.waitForTimeout(300);
      await check(page, open);
      await page.keyboard.press('Escape');
      await expect(page.getByRole('dialog')).toHaveCount(0);
    }
  });

  test(`the start page and its errors are accessible, ${colorScheme}`, async ({ page, start }) => {
    await page.emulateMedia({ colorScheme });
    const program = await start(['--folder', join(model, '..')]);
    await page.goto(program.address);
    await expect(page.getByRole('button', { name: /^\S+scenes$/ })).toBeVisible();
    await check(page, 'the start page');
    await page.locator('input[type=file]').first().setInputFiles({ name: 'broken.stp', mimeType: 'application/step', buffer: Buffer.from('this is no STEP file') });
    await expect(page.getByTestId('open-failure')).toContainText('broken.stp');
    await check(page, 'a file that cannot be read');
    await program.kill();
    await expect(page.getByTestId('lost')).toBeVisible();
    await check(page, 'the connection is lost');
  });
}
