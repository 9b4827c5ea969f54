// Tells the program where the pointer is: what is near it grows before the rest.
import { send } from '../state/session';

const reach = 96; // CSS pixels to each side
const leastMove = 48; // of the pointer, before it is told again
const leastMilliseconds = 200;

export class Attention {
  private told: { x: number; y: number } | null = null;
  private at: { x: number; y: number } | null = null; // CSS pixels in the view
  private timer = 0;

  // pixels: of the picture for each CSS pixel.
  constructor(private readonly pixels: () => number) {}

  // To a place of the view, or to nothing in particular.
  turnTo(at: { x: number; y: number } | null): void {
    this.at = at;
    if (this.timer !== 0) return;
    this.timer = window.setTimeout(() => {
      this.timer = 0;
      this.tell();
    }, leastMilliseconds);
  }

  // A connection that is new knows of nothing.
  forget(): void {
    this.told = null;
  }

  dispose(): void {
    clearTimeout(this.timer);
  }

  private tell(): void {
    const { at, told } = this;
    if (at === told || (at && told && Math.hypot(at.x - told.x, at.y - told.y) < leastMove)) return;
    const scale = this.pixels();
    const place = (c: number) => Math.max(0, Math.round((c - reach) * scale));
    const area = at && { x: place(at.x), y: place(at.y), width: Math.round(2 * reach * scale), height: Math.round(2 * reach * scale) };
    if (send({ attend: area })) this.told = at;
  }
}
