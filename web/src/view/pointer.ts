// What the pointer does to the picture besides moving the camera: click selects, double click focuses, hovering marks, pressing finds the point to turn about, and a material is dropped.
import { ask } from '../state/session';
import { assignDropped } from '../state/materials';
import { hover, select } from '../state/selection';
import { get, set } from '../state/store';
import { leafOf, pathOf } from '../state/tree';
import { Vector3 } from 'three';
import type { Picked } from '../protocol/messages';
import type { Stage } from './stage';

const clickPixels = 4;
const wheelPauseMilliseconds = 250;
export const materialType = 'application/x-crescente-material';

export class Pointer {
  private down: { x: number; y: number; id: number } | null = null;
  private hovering = false;
  private nextHover: PointerEvent | null = null;
  private lastWheel = 0;
  private readonly stop = new AbortController();

  constructor(private readonly element: HTMLElement, private readonly stage: Stage) {
    const on = <K extends keyof HTMLElementEventMap>(type: K, listener: (event: HTMLElementEventMap[K]) => void, capture = false) =>
      element.addEventListener(type, listener, { signal: this.stop.signal, capture, passive: type === 'wheel' ? true : undefined });
    on('pointerdown', (event) => this.press(event), true);
    on('pointermove', (event) => this.move(event));
    on('pointerup', (event) => void this.release(event));
    on('pointerleave', () => hover(null));
    on('dblclick', () => this.stage.fit());
    on('wheel', (event) => void this.wheel(event), true);
    on('dragover', (event) => {
      if (event.dataTransfer?.types.includes(materialType)) event.preventDefault();
    });
    on('drop', (event) => void this.drop(event));
  }

  dispose(): void {
    this.stop.abort();
  }

  private async pick(clientX: number, clientY: number): Promise<Picked | null | undefined> {
    const pixel = this.stage.pixelAt(clientX, clientY);
    if (!pixel || !get().scene) return undefined;
    return (await ask({ pick: pixel }))?.picked;
  }

  private press(event: PointerEvent): void {
    if (event.target instanceof HTMLButtonElement) return;
    this.element.focus({ preventScroll: true });
    set({ turntable: false });
    this.down = { x: event.clientX, y: event.clientY, id: event.pointerId };
    hover(null);
    this.stage.navigation.leftPans(event.shiftKey);
    if (event.button !== 0 || this.stage.overHandle) return;
    const { id } = this.down;
    void this.pick(event.clientX, event.clientY).then((picked) => {
      if (picked && this.down?.id === id && !this.stage.busy) this.stage.navigation.pivotAt(new Vector3(...picked.position));
    });
  }

  private async release(event: PointerEvent): Promise<void> {
    const down = this.down;
    this.down = null;
    if (!down || event.button !== 0 || this.stage.busy || this.stage.overHandle || event.target instanceof HTMLButtonElement) return;
    if (Math.hypot(event.clientX - down.x, event.clientY - down.y) > clickPixels) return;
    const picked = await this.pick(event.clientX, event.clientY);
    if (picked === undefined) return;
    set({ pixel: this.stage.pixelAt(event.clientX, event.clientY), point: picked?.position ?? null });
    select(picked ? pathOf(picked.path) : null, event.ctrlKey || event.metaKey || event.shiftKey);
  }

  private move(event: PointerEvent): void {
    if (this.down || event.pointerType === 'touch') return;
    this.nextHover = event;
    void this.askHover();
  }

  // One question at a time, about the newest place.
  private async askHover(): Promise<void> {
    if (this.hovering) return;
    this.hovering = true;
    while (this.nextHover) {
      const { clientX, clientY } = this.nextHover;
      this.nextHover = null;
      const picked = await this.pick(clientX, clientY);
      if (!this.down) hover(picked ? pathOf(picked.path) : null);
      await new Promise((resume) => setTimeout(resume, 30));
    }
    this.hovering = false;
  }

  private async wheel(event: WheelEvent): Promise<void> {
    const first = event.timeStamp - this.lastWheel > wheelPauseMilliseconds;
    this.lastWheel = event.timeStamp;
    if (!first) return;
    const picked = await this.pick(event.clientX, event.clientY);
    if (picked) this.stage.navigation.zoomTo(new Vector3(...picked.position));
  }

  private async drop(event: DragEvent): Promise<void> {
    const text = event.dataTransfer?.getData(materialType);
    if (!text) return;
    event.preventDefault();
    event.stopPropagation();
    const { clientX, clientY } = event;
    const picked = await this.pick(clientX, clientY);
    if (!picked) return;
    const path = pathOf(picked.path);
    if (await assignDropped([leafOf(path)], text)) select(path);
  }
}
