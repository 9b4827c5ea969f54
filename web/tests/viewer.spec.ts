// What users do with the page, from opening a model to exporting its picture.
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { PNG } from 'pngjs';
import { converged, expect, findHandle, folder, growTo, model, picture, pixels, plate, run, selectPart, test, visit } from './program';

test('a model opens, its picture grows and converges', async ({ page, start }) => {
  await visit(page, await start());
  await expect(page).toHaveTitle(/^as1 – Crescente$/);
  const first = await pixels(page);
  await growTo(page, 'shadows');
  await converged(page, first);
  await expect(page.getByRole('treeitem', { name: 'plate' })).toBeVisible();
});

test('dragging turns the view, at once and then in the picture', async ({ page, start }) => {
  await visit(page, await start());
  await growTo(page, 'visible');
  await converged(page);
  const before = await pixels(page);
  const transform = () => page.locator('.picture').evaluate((canvas) => (canvas as HTMLElement).style.transform);
  const still = await transform();
  // Whether the picture was seen warped to the new camera before the program had sent anything of it.
  await page.evaluate(() => {
    const canvas = document.querySelector<HTMLElement>('.picture');
    new MutationObserver(() => canvas?.style.transform.startsWith('matrix3d') && document.body.setAttribute('data-warped', 'true')).observe(canvas as Node, { attributes: true });
  });
  await page.mouse.move(plate.x, plate.y);
  await page.mouse.down();
  await page.mouse.move(plate.x + 60, plate.y + 10, { steps: 6 });
  await page.mouse.up();
  await expect(page.locator('body')).toHaveAttribute('data-warped', 'true');
  await converged(page, before);
  await expect.poll(transform).toBe(still);
});

test('a click picks the part, and hides or isolates it', async ({ page, start }) => {
  await visit(page, await start());
  await growTo(page, 'visible');
  await selectPart(page);
  await converged(page);
  const before = await pixels(page);
  await page.getByTestId('stage').focus();
  await page.keyboard.press('h');
  await expect(page.locator('[role=treeitem][data-hidden=true]')).not.toHaveCount(0);
  await converged(page, before);
  await page.keyboard.press('Control+z');
  await expect(page.locator('[role=treeitem][data-hidden=true]')).toHaveCount(0);
  await expect.poll(() => pixels(page)).toBe(before);
});

test('a material is changed without a camera ray, and taken back', async ({ page, start }) => {
  await visit(page, await start());
  await growTo(page, 'shadows');
  await converged(page);
  const before = await pixels(page);
  await selectPart(page);
  const slider = page.getByTestId('slider-roughness').getByRole('slider');
  await slider.focus();
  for (let i = 0; i < 5; i++) await page.keyboard.press('ArrowRight');
  await expect(page.getByTestId('undo')).toBeEnabled();
  await converged(page, before);
  await page.getByTestId('tab-numbers').click();
  await expect(page.getByTestId('numbers')).toHaveAttribute('data-edit-camera-rays', '0');
  while (await page.getByTestId('undo').isEnabled()) {
    await page.getByTestId('undo').click();
    await page.waitForTimeout(100);
  }
  await expect.poll(() => pixels(page)).toBe(before);
});

test('a material of the library is dragged onto a part', async ({ page, start }) => {
  await visit(page, await start());
  await growTo(page, 'visible');
  await converged(page);
  const before = await pixels(page);
  await page.getByRole('button', { name: 'brass polished' }).dragTo(page.getByTestId('stage'), { targetPosition: plate });
  await expect(page.getByTestId('scene-materials').getByRole('button', { name: 'brass polished' })).toBeVisible();
  await expect(page.getByRole('treeitem', { name: 'plate' })).toHaveAttribute('aria-selected', 'true');
  await converged(page, before);
});

test('a part is moved by its handles; one drag is one undo', async ({ page, start }) => {
  await visit(page, await start());
  await growTo(page, 'visible');
  await converged(page);
  const before = await pixels(page);
  await selectPart(page);
  await page.getByTestId('tab-object').click();
  const height = page.getByLabel(/^Position, y/);
  const at = await height.inputValue();
  await page.getByTestId('stage').focus();
  await page.keyboard.press('m');
  const handle = await findHandle(page);
  await page.mouse.move(handle.x, handle.y);
  await page.mouse.down();
  await page.mouse.move(handle.x, handle.y - 50, { steps: 8 });
  await page.mouse.up();
  await expect(height).not.toHaveValue(at);
  await converged(page, before);
  await page.getByTestId('undo').click();
  await expect(height).toHaveValue(at);
  await expect(page.getByTestId('undo')).toBeDisabled();
  await expect.poll(() => pixels(page)).toBe(before);
});

test('a light is added, changed and deleted', async ({ page, start }) => {
  await visit(page, await start());
  await growTo(page, 'visible');
  await converged(page);
  const before = await pixels(page);
  await page.getByTestId('tab-lights').click();
  const lights = page.getByTestId('lights').getByRole('listitem');
  const count = await lights.count();
  await page.getByRole('button', { name: 'Add a light' }).click();
  await page.getByRole('menuitem', { name: 'Spot' }).click();
  await expect(lights).toHaveCount(count + 1);
  await converged(page, before);
  const lit = await pixels(page);
  const intensity = page.getByRole('textbox', { name: 'Intensity' });
  await intensity.fill('0');
  await intensity.press('Enter');
  await expect.poll(() => pixels(page)).not.toBe(lit);
  await converged(page);
  await page.getByRole('button', { name: 'Delete light spot 1' }).click();
  await expect(lights).toHaveCount(count);
  await expect.poll(() => pixels(page)).toBe(before);
});

test('an exported picture is that of the command line, and of the screen', async ({ page, start }) => {
  // The camera by which the picture is seen is the last that the page told.
  let camera: Record<string, unknown> = {};
  page.on('websocket', (socket) => socket.on('framesent', ({ payload }) => {
    const message = JSON.parse(String(payload)) as { look?: Record<string, unknown> };
    camera = message.look ?? camera;
  }));
  await visit(page, await start());
  await growTo(page, 'shadows');
  await converged(page);
  const shown = await picture(page);

  await page.getByRole('button', { name: 'Export picture' }).click();
  await page.getByTestId('export-start').click();
  await expect(page.getByTestId('export-item').last()).toHaveAttribute('data-done', 'true', { timeout: 45_000 });
  const download = page.waitForEvent('download');
  await page.getByTestId('download').last().click();
  const exported = join(folder, 'exported.png');
  await (await download).saveAs(exported);

  const rendered = join(folder, 'rendered.png');
  const script = join(folder, 'camera.jsonl');
  writeFileSync(script, `${JSON.stringify({ camera })}\n${JSON.stringify({ picture: rendered })}\n`);
  run('edit', model, script, '--size', `${shown.width}x${shown.height}`, '--level', 'shadows');
  const [a, b] = [exported, rendered].map((file) => PNG.sync.read(readFileSync(file)));
  expect([a.width, a.height]).toEqual([shown.width, shown.height]);
  expect(a.data.equals(shown.data), 'the exported picture and the one on the screen').toBe(true);
  expect(a.data.equals(b.data), 'the exported picture and the one of the command line').toBe(true);
});

test('a scene is saved as the command line reads it', async ({ page, start }) => {
  await visit(page, await start([join(model, '../cornell.json')]));
  await page.getByTestId('file-menu').click();
  const saved = page.waitForEvent('download');
  await page.getByRole('menuitem', { name: 'Save scene' }).click();
  const scene = join(folder, 'saved.json');
  await (await saved).saveAs(scene);
  run('render', scene, '-o', join(folder, 'saved.png'), '--size', '64x64', '--level', 'visible');
});

test('after a reload the session goes on', async ({ page, start }) => {
  await visit(page, await start());
  await growTo(page, 'visible');
  await converged(page);
  await page.getByRole('treeitem', { name: 'plate' }).click();
  await page.getByTestId('stage').focus();
  await page.keyboard.press('h');
  await page.keyboard.press('ArrowRight');
  await expect(page.locator('[role=treeitem][data-hidden=true]')).not.toHaveCount(0);
  await page.waitForTimeout(1000); // the turn comes to its end
  await converged(page);
  const before = await pixels(page);
  await page.reload();
  await converged(page);
  expect(await pixels(page)).toBe(before);
  await expect(page.locator('[role=treeitem][data-hidden=true]')).not.toHaveCount(0);
  await expect(page.getByTestId('undo')).toBeEnabled();
});

test('a model is opened from a folder; a bad file is told', async ({ page, start }) => {
  const program = await start(['--folder', join(model, '..')]);
  await page.goto(program.address);
  await page.getByRole('button', { name: /^\S+scenes$/ }).click();
  const assembly = page.getByTestId('file').filter({ hasText: 'as1-oc-214.stp' }); // not among those that were opened lately
  await expect(assembly).toBeVisible();
  await page.locator('input[type=file]').first().setInputFiles({ name: 'broken.stp', mimeType: 'application/step', buffer: Buffer.from('this is no STEP file') });
  await expect(page.getByTestId('open-failure')).toContainText('broken.stp');
  await assembly.click();
  await expect(page.getByTestId('stage')).toHaveAttribute('data-frames', /\d/);
});
