// The picture as it has come so far, at the size at which it is rendered. Parts are decoded by the browser and drawn together, frame after frame in their order.
import { parseFrame, type Frame, type Part } from '../protocol/frame';

type Decoded = ImageBitmap | VideoFrame;

// WebCodecs, where the browser has it (on this machine or by https): to make a Blob, a page waits for the browser's own process, for longer than a picture takes to be decoded. Pictures without loss
// go the other way, which keeps every bit, alpha included; they are few.
async function decode({ data, mime }: Part): Promise<Decoded> {
  if (mime !== 'image/jpeg' || !('ImageDecoder' in window)) return createImageBitmap(new Blob([data], { type: mime }), { colorSpaceConversion: 'none', premultiplyAlpha: 'default' });
  const decoder = new ImageDecoder({ data, type: mime, colorSpaceConversion: 'none' });
  try {
    return (await decoder.decode()).image;
  } finally {
    decoder.close();
  }
}

export class Picture {
  readonly canvas = document.createElement('canvas');
  // How many `look`s the picture knows of; null before the first frame.
  look: number | null = null;
  frames = 0;
  private readonly context: CanvasRenderingContext2D;
  private last: Promise<void> = Promise.resolve();

  // drawn: called for each frame once its pixels are on the canvas.
  constructor(private readonly drawn: (frame: Frame) => void) {
    const context = this.canvas.getContext('2d');
    if (!context) throw new Error('this browser draws no pictures');
    this.context = context;
    this.canvas.className = 'picture';
  }

  receive(data: ArrayBuffer): void {
    const frame = parseFrame(data);
    const images = Promise.all(frame.parts.map(decode));
    images.catch(() => undefined); // told below, in the order of the frames
    this.last = this.last.then(async () => this.draw(frame, await images)).catch((error: unknown) => console.error('frame', frame.number, error));
  }

  forget(): void {
    this.look = null;
  }

  private draw(frame: Frame, images: Decoded[]): void {
    if (this.canvas.width !== frame.width || this.canvas.height !== frame.height) {
      this.canvas.width = frame.width;
      this.canvas.height = frame.height;
    }
    frame.parts.forEach((part, i) => {
      this.context.clearRect(part.x, part.y, part.width, part.height);
      this.context.drawImage(images[i], part.x, part.y, part.width, part.height); // it may have fewer pixels
      images[i].close();
    });
    this.look = frame.look;
    this.frames++;
    this.drawn(frame);
  }
}
