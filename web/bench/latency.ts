// How long after the hand the picture follows: pointer move to changed pixels, material slider to changed pixels. At 1280x720, in Chromium, with the program on the same machine.
//
//     npm run bench                     the small assembly of scenes/, or MODEL=part.step npm run bench
//
// The time is from the browser's own stamp of the event until the beginning of the frame after the one in which pixels changed, when they are on the screen.
import { expect, model, Program, test, visit } from '../tests/program';
import type { Page } from '@playwright/test';

const rounds = 60;

type Watch = { begin: number; warped: number; drawn: number };

// Notes, from each stamped event on, when the picture was moved next, and when pixels were drawn that answer to it: a frame that is seen by the camera that the event led to, or one that came after
// the program said that the edit is done. Frames that were under way before count for nothing.
const watch = () => {
  const page = window as unknown as { watched: Watch; watchFrom(type: string): void };
  const empty = () => ({ begin: 0, warped: 0, drawn: 0 });
  page.watched = empty();
  let cameras = 0; // that were told
  let wanted: (look: number, afterEdit: boolean) => boolean = () => false;
  let edited = false;
  const frames = new Map<number, [number, boolean]>();
  const note = (what: 'warped' | 'drawn') => {
    const now = page.watched;
    if (now.begin > 0 && now[what] === 0) requestAnimationFrame((time) => { if (now[what] === 0) now[what] = Math.max(time, now.begin); });
  };
  const Socket = window.WebSocket;
  window.WebSocket = class extends Socket {
    constructor(url: string | URL, protocols?: string | string[]) {
      super(url, protocols);
      this.addEventListener('message', ({ data }: MessageEvent<string | ArrayBuffer>) => {
        if (typeof data === 'string') edited ||= data.startsWith('{"edited"');
        else frames.set(new DataView(data).getUint32(4, true), [new DataView(data).getUint32(8, true), edited]);
      });
    }
    override send(data: string): void {
      super.send(data);
      if (data.startsWith('{"look"')) cameras++;
      const shown = /^\{"shown":(\d+)/.exec(data);
      const frame = shown && frames.get(Number(shown[1]));
      if (frame && wanted(...frame)) note('drawn');
    }
  };
  page.watchFrom = (type) => {
    window.addEventListener(type, (event) => {
      const next = cameras + 1;
      edited = false;
      frames.clear();
      wanted = type === 'keydown' ? (_, afterEdit) => afterEdit : (look) => look >= next;
      page.watched = { ...empty(), begin: event.timeStamp };
    }, true);
    new MutationObserver(() => note('warped')).observe(document.querySelector('.picture') as Node, { attributeFilter: ['style'] });
  };
};

const watchFrom = (page: Page, type: string) => page.evaluate((event) => (window as unknown as { watchFrom(type: string): void }).watchFrom(event), type);

const read = async (page: Page): Promise<Watch> => page.evaluate(() => ({ ...(window as unknown as { watched: Watch }).watched }));

async function until(page: Page, what: 'warped' | 'drawn'): Promise<number> {
  for (;;) {
    const now = await read(page);
    if (now[what] > 0) return now[what] - now.begin;
    await page.waitForTimeout(10);
  }
}

function tell(what: string, times: number[]): void {
  times.sort((a, b) => a - b);
  const at = (share: number) => times[Math.min(times.length - 1, Math.floor(times.length * share))].toFixed(0);
  console.log(`${what}: median ${at(0.5)} ms, 95th percentile ${at(0.95)} ms, of ${times.length}`);
}

test('latency', async ({ page }) => {
  const program = await Program.start([process.env.MODEL ?? model]);
  try {
    await page.addInitScript(watch);
    await visit(page, program);
    await page.waitForTimeout(3000);

    await watchFrom(page, 'pointermove');
    await page.mouse.move(600, 400);
    await page.mouse.down();
    const warped: number[] = [];
    const drawn: number[] = [];
    for (let i = 0; i < rounds; i++) {
      await page.mouse.move(600 + 3 * (i % 20) + 1, 400 + (i % 7));
      warped.push(await until(page, 'warped'));
      drawn.push(await until(page, 'drawn'));
      await page.waitForTimeout(40);
    }
    await page.mouse.up();
    tell('pointer move to the picture moved in the browser', warped);
    tell('pointer move to pixels of the new camera', drawn);

    await page.getByRole('treeitem', { name: 'plate' }).click();
    await expect(page.locator('[role=treeitem][aria-selected=true]')).toHaveCount(1);
    await page.waitForTimeout(3000);
    const slider = page.getByTestId('slider-roughness').getByRole('slider');
    await slider.focus();
    await page.mouse.move(640, 5); // away from the picture
    await watchFrom(page, 'keydown');
    const edited: number[] = [];
    for (let i = 0; i < rounds; i++) {
      await page.keyboard.press(i % 20 < 10 ? 'ArrowRight' : 'ArrowLeft');
      edited.push(await until(page, 'drawn'));
      await page.waitForTimeout(60);
    }
    tell('material slider to changed pixels', edited);
  } finally {
    await program.kill();
  }
});
