// Parts of the picture in a binary message (docs/protocol.md, Frames).

export type Part = { x: number; y: number; width: number; height: number; mime: string; data: Uint8Array<ArrayBuffer> };

export type Frame = {
  number: number;
  look: number; // how many `look`s the picture knows of: the camera it is seen by
  width: number;
  height: number;
  converged: boolean; // and without loss
  anew: boolean;
  parts: Part[];
};

const magic = 0x31465243; // "CRF1"
const headerBytes = 20;
const partBytes = 16;

// Throws where the message does not follow the protocol.
export function parseFrame(message: ArrayBuffer): Frame {
  const view = new DataView(message);
  if (message.byteLength < headerBytes || view.getUint32(0, true) !== magic) throw new Error('a binary message that is no frame');
  const frame: Frame = {
    number: view.getUint32(4, true),
    look: view.getUint32(8, true),
    width: view.getUint16(12, true),
    height: view.getUint16(14, true),
    converged: view.getUint8(16) === 1,
    anew: view.getUint8(17) === 1,
    parts: [],
  };
  const count = view.getUint16(18, true);
  let at = headerBytes;
  for (let i = 0; i < count; i++) {
    if (at + partBytes > message.byteLength) throw new Error(`frame ${frame.number} ends within part ${i}`);
    const length = view.getUint32(at + 12, true);
    if (at + partBytes + length > message.byteLength) throw new Error(`frame ${frame.number} ends within the data of part ${i}`);
    const data = new Uint8Array(message, at + partBytes, length);
    frame.parts.push({
      x: view.getUint16(at, true),
      y: view.getUint16(at + 2, true),
      width: view.getUint16(at + 4, true),
      height: view.getUint16(at + 6, true),
      mime: mimeOf(view.getUint8(at + 8), data),
      data,
    });
    at += partBytes + length;
  }
  return frame;
}

function mimeOf(encoding: number, data: Uint8Array): string {
  if (encoding === 0) return 'image/jpeg';
  return data[0] === 0x89 ? 'image/png' : 'image/webp';
}
