// What happens when the way to the program is slow, or ends.
import { expect, growTo, converged, pixels, test, visit } from './program';

// Lets the page's word that it has drawn a frame wait, as long as one wants: to the program the page is slow.
const holdWord = () => {
  const page = window as unknown as { hold: boolean; release(): void };
  const send = WebSocket.prototype.send;
  const held: (() => void)[] = [];
  WebSocket.prototype.send = function (data) {
    if (page.hold && typeof data === 'string' && data.startsWith('{"shown"')) held.push(() => send.call(this, data));
    else send.call(this, data);
  };
  page.release = () => {
    page.hold = false;
    held.splice(0).forEach((say) => say());
  };
};

test('a slow page gets two frames and no more until it has drawn them, and in the end the same picture', async ({ page, start }) => {
  await page.addInitScript(holdWord);
  await visit(page, await start());
  await growTo(page, 'shadows');
  await converged(page);
  const expected = await pixels(page);
  const frames = async () => Number(await page.getByTestId('stage').getAttribute('data-frames'));

  await page.evaluate(() => sessionStorage.clear()); // the next session begins anew
  await page.addInitScript(() => ((window as unknown as { hold: boolean }).hold = true));
  await page.reload();
  await expect(page.getByTestId('stage')).toHaveAttribute('data-frames', /\d/);
  await growTo(page, 'shadows');
  await expect(page.getByTestId('status')).toHaveAttribute('data-state', 'finished');
  expect(await frames()).toBeLessThanOrEqual(2);
  await page.evaluate(() => (window as unknown as { release(): void }).release());
  await converged(page);
  expect(await pixels(page)).toBe(expected);
});

test('when the program is killed the page says so, keeps the picture, and finds the next one', async ({ page, start }) => {
  const program = await start();
  await visit(page, program);
  const port = new URL(program.address).port;
  await program.kill();
  await expect(page.getByTestId('lost')).toBeVisible();
  await expect(page.locator('.picture')).toBeVisible();
  // A program begun anew has another token, so that the page must be opened at its address.
  const next = await start(['--port', port]);
  await page.goto(next.address);
  await expect(page.getByText('Drop a model here')).toBeVisible();
  await expect(page.getByTestId('lost')).toHaveCount(0);
});
