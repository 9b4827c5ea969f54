// The tools of the page, one after the other, as one who looks for what does not work.
import { readFileSync, writeFileSync } from 'node:fs';
import { basename, join } from 'node:path';
import { PNG } from 'pngjs';
import { cameras, converged, expect, folder, growTo, model, pixels, plate, press, rested, run, selectPart, settled, test, visit } from './program';
import type { Page } from '@playwright/test';

const rows = (page: Page) => page.getByRole('treeitem');
const undoAll = async (page: Page) => {
  while (await page.getByTestId('undo').isEnabled()) {
    await page.getByTestId('undo').click();
    await page.waitForTimeout(150);
  }
};

test('views: from the menu, kept by name, turntable, the other projection', async ({ page, start }) => {
  const told = cameras(page);
  await visit(page, await start());
  await growTo(page, 'visible');
  await page.getByRole('button', { name: 'Views' }).click();
  await page.getByRole('menuitem', { name: /^front/i }).click();
  const last = () => told[told.length - 1];
  await expect.poll(() => (last().position[2] - last().target[2]) / Math.hypot(...last().position.map((x, i) => x - last().target[i]))).toBeGreaterThan(0.99);
  await settled(page, told);
  const front = last();

  await page.getByTestId('tab-cameras').click();
  await page.getByLabel('Name of this view').fill('from the front');
  await page.getByRole('button', { name: 'Keep' }).click();
  await press(page, '5');
  await expect.poll(() => last().position[1]).toBeGreaterThan(front.position[1] + 10);
  await page.reload();
  await expect(page.getByTestId('stage')).toHaveAttribute('data-frames', /\d/);
  await page.getByTestId('tab-cameras').click();
  await page.getByRole('button', { name: 'from the front', exact: true }).click();
  await expect.poll(() => Math.max(...last().position.map((x, i) => Math.abs(x - front.position[i])))).toBeLessThan(5e-4);

  await press(page, 'p');
  await expect.poll(() => last().projection).toBe('orthographic');
  await press(page, 'p');
  await expect.poll(() => last().projection).toBe('perspective');
  const before = told.length;
  await press(page, 't');
  await expect.poll(() => told.length - before).toBeGreaterThan(5);
  await page.mouse.click(plate.x, plate.y); // stops it
  await settled(page, told);
  const stopped = told.length;
  await rested(page);
  expect(told.length).toBe(stopped);
});

test('parts: found, hidden, shown alone, copied, deleted, and all of it taken back and made again', async ({ page, start }) => {
  await visit(page, await start());
  await growTo(page, 'visible');
  await converged(page);
  const before = await pixels(page);
  const count = await rows(page).count();
  await page.getByLabel('Search parts').fill('nut');
  await expect(rows(page).filter({ hasText: 'nut' }).first()).toBeVisible();
  await expect(rows(page).filter({ hasText: 'plate' })).toHaveCount(0);
  await page.getByLabel('Search parts').fill('');
  await expect(rows(page)).toHaveCount(count);

  await selectPart(page);
  await press(page, 'i');
  await expect(page.getByText('Others are hidden')).toBeVisible();
  await converged(page, before);
  await press(page, 'i');
  await expect(page.getByText('Others are hidden')).toHaveCount(0);
  await expect.poll(() => pixels(page)).toBe(before);

  await press(page, 'Control+d');
  await expect(rows(page)).toHaveCount(count + 1);
  await converged(page, before);
  const two = await pixels(page);
  await rows(page).filter({ hasText: 'copy' }).click();
  await press(page, 'Delete');
  await expect(rows(page)).toHaveCount(count);
  await expect.poll(() => pixels(page)).toBe(before);
  await press(page, 'Control+z');
  await expect(rows(page)).toHaveCount(count + 1);
  await expect.poll(() => pixels(page)).toBe(two);
  await press(page, 'Control+z');
  await expect(rows(page)).toHaveCount(count);
  await press(page, 'Control+y');
  await expect(rows(page)).toHaveCount(count + 1);
  await expect.poll(() => pixels(page)).toBe(two);
  await undoAll(page);
  await expect.poll(() => pixels(page)).toBe(before);
});

test('studio, ground, surroundings and their turn, and each taken back', async ({ page, start }) => {
  await visit(page, await start());
  await growTo(page, 'visible');
  await converged(page);
  const shown = [await pixels(page)];
  const changed = async () => {
    await converged(page, shown[shown.length - 1]);
    shown.push(await pixels(page));
  };
  await page.getByTestId('tab-studio').click();
  await page.getByTestId('studio').click();
  await page.getByRole('option', { name: 'Tent' }).click();
  await changed();
  await page.getByText('None', { exact: true }).click();
  await changed();
  // A picture of eight by four pixels, of another colour in each.
  const sky = Buffer.concat([Buffer.from('#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n'), Buffer.from(Array.from({ length: 128 }, (_, i) => (i % 4 === 3 ? 129 : (i * 37) % 256)))]);
  await page.getByLabel('Picture of surroundings').setInputFiles({ name: 'sky.hdr', mimeType: 'image/vnd.radiance', buffer: sky });
  await changed();
  const turn = page.getByTestId('slider-rotation').getByRole('slider');
  await turn.focus();
  await turn.press('PageUp').catch(() => undefined);
  for (let i = 0; i < 5; i++) await turn.press('ArrowRight');
  await changed();
  for (let i = shown.length - 2; i >= 0; i--) {
    for (let n = 0; n < 8 && (await pixels(page)) !== shown[i]; n++) {
      if (await page.getByTestId('undo').isEnabled()) await page.getByTestId('undo').click();
      await page.waitForTimeout(400);
      await converged(page);
    }
    expect(await pixels(page), `state ${i}`).toBe(shown[i]);
  }
});

test('maps, the rays of a pixel, pause', async ({ page, start }) => {
  await visit(page, await start());
  await growTo(page, 'shadows');
  await converged(page);
  const color = await pixels(page);
  await page.mouse.click(plate.x, plate.y);
  await page.getByTestId('tab-numbers').click();
  await page.getByTestId('replay').click();
  await expect(page.getByRole('tree', { name: 'Rays' }).getByRole('treeitem').first()).toContainText('plate');
  for (const map of ['Samples', 'Influence', 'Level']) {
    await page.getByTestId('layers').getByText(map).click();
    await expect.poll(() => pixels(page)).not.toBe(color);
  }
  await page.getByTestId('layers').getByText('Color').click();
  await expect.poll(() => pixels(page)).toBe(color);

  await press(page, 'Space');
  await expect(page.getByTestId('status')).toHaveAttribute('data-state', 'paused');
  await press(page, 'ArrowRight');
  await rested(page);
  await expect(page.getByTestId('status')).toHaveAttribute('data-state', 'paused');
  await press(page, 'Space');
  await expect(page.getByTestId('status')).toHaveAttribute('data-state', 'finished');
});

test('pictures of another size, with layers, and copied', async ({ page, context, start }) => {
  await context.grantPermissions(['clipboard-read', 'clipboard-write']);
  const told = cameras(page);
  await visit(page, await start());
  await growTo(page, 'visible');
  await press(page, 'ArrowRight');
  await rested(page);
  const camera = join(folder, 'look.jsonl');
  for (const format of ['png', 'exr']) {
    await page.getByRole('button', { name: 'Export picture' }).click();
    await page.getByTestId('export-width').fill('333');
    await page.getByTestId('export-height').fill('201');
    await page.getByRole('textbox', { name: 'Format' }).click();
    await page.getByRole('option', { name: format.toUpperCase() }).click();
    await page.getByTestId('export-start').click();
    await expect(page.getByTestId('export-item').last()).toHaveAttribute('data-done', 'true');
    const download = page.waitForEvent('download');
    await page.getByTestId('download').last().click();
    const exported = join(folder, `page.${format}`);
    await (await download).saveAs(exported);
    await page.keyboard.press('Escape');
    const rendered = join(folder, `line.${format}`);
    writeFileSync(camera, `${JSON.stringify({ camera: told[told.length - 1] })}\n${JSON.stringify({ picture: rendered })}\n`);
    run('edit', model, camera, '--size', '333x201', '--level', 'visible');
    const [a, b] = [exported, rendered].map((file) => readFileSync(file));
    if (format === 'png') expect(PNG.sync.read(a).data.equals(PNG.sync.read(b).data)).toBe(true);
    else for (const channel of ['influence', 'samples', 'level']) expect(a.includes(channel), `the layer ${channel} is in the file`).toBe(true);
  }
  await page.getByTestId('file-menu').click();
  await page.getByRole('menuitem', { name: 'Copy picture' }).click();
  await expect.poll(() => page.evaluate(async () => (await navigator.clipboard.read())[0].types.join())).toContain('image/png');
});

test('a model is dropped onto the page, and is there among the recent ones', async ({ page, start }) => {
  const program = await start([]);
  await page.goto(program.address);
  await expect(page.getByText('Drop a model here')).toBeVisible();
  const data = await page.evaluateHandle(({ text, name }) => {
    const transfer = new DataTransfer();
    transfer.items.add(new File([text], name, { type: 'application/step' }));
    return transfer;
  }, { text: readFileSync(model, 'latin1'), name: basename(model) });
  await page.dispatchEvent('body', 'dragenter', { dataTransfer: data });
  await expect(page.getByText('Drop to open')).toBeVisible();
  await page.getByText('Drop to open').dispatchEvent('drop', { dataTransfer: data });
  await expect(page.getByTestId('stage')).toHaveAttribute('data-frames', /\d/);
  await expect(rows(page).filter({ hasText: 'plate' })).toBeVisible();

  // What the program can read again, unlike an upload, is kept in mind.
  await page.evaluate(() => sessionStorage.clear());
  await page.goto((await start()).address);
  await expect(page.getByTestId('stage')).toHaveAttribute('data-frames', /\d/);
  await page.evaluate(() => sessionStorage.clear());
  await page.goto((await start([])).address);
  await page.getByRole('region', { name: 'Recent' }).getByRole('button', { name: basename(model) }).click();
  await expect(page.getByTestId('stage')).toHaveAttribute('data-frames', /\d/);
});

test('two pages have a session each', async ({ page, context, start }) => {
  const program = await start();
  await visit(page, program);
  const other = await context.newPage();
  await visit(other, program);
  for (const one of [page, other]) {
    await growTo(one, 'visible');
    await converged(one);
  }
  const before = await pixels(other);
  await selectPart(page);
  await press(page, 'h');
  await converged(page, before);
  await expect(page.locator('[role=treeitem][data-hidden=true]')).not.toHaveCount(0);
  await expect(other.locator('[role=treeitem][data-hidden=true]')).toHaveCount(0);
  expect(await pixels(other)).toBe(before);
});
