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

// Marks and handles of lights have the pointer for themselves.
const onHandle = (event: Event) => event.target instanceof Element && event.target.closest('button, [role=slider]') !== null;

export class Pointer {
  private down: { x: number; y: number; id: number } | null = null;
  private readonly pressed = new Set<number>(); // pointers: with two fingers on the picture neither clicks
  private hovering = false;
  private nextHover: PointerEvent | null = null;
  private lastWheel = 0;
  private chosen: Promise<void> = Promise.resolve(); // once what was clicked last is selected
  private readonly stop = new AbortController();

  constructor(private readonly element: HTMLElement, private readonly stage: Stage) {
    const on = <K extends keyof HTMLElementEventMap>(type: K, listener: (event: HTMLElementEventMap[K]) => void, capture = false) =>
      element.addEventListener(type, listener, { signal: this.stop.signal, capture, passive: type === 'wheel' ? true : undefined });
    on('pointerdown', (event) => this.press(event), true);
    on('pointermove', (event) => this.move(event));
    on('pointerup', (event) => {
      this.chosen = this.release(event);
    });
    on('pointercancel', (event) => this.lift(event));
    on('pointerleave', (event) => {
      this.pressed.delete(event.pointerId);
      this.stage.attention.turnTo(null);
      hover(null);
    });
    on('dblclick', (event) => {
      if (!onHandle(event)) void this.chosen.then(() => this.stage.fit());
    });
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
    if (onHandle(event)) return;
    this.element.focus({ preventScroll: true });
    set({ turntable: false });
    this.pressed.add(event.pointerId);
    if (this.pressed.size > 1) {
      this.down = null;
      return;
    }
    this.down = { x: event.clientX, y: event.clientY, id: event.pointerId };
    hover(null);
    this.stage.navigation.leftPans(event.shiftKey);
    if (event.button !== 0 || this.stage.overHandle) return;
    const { id } = this.down;
    void this.pick(event.clientX, event.clientY).then((picked) => {
      if (picked && this.down?.id === id && !this.stage.busy) this.stage.navigation.pivotAt(new Vector3(...picked.position));
    });
  }

  private lift(event: PointerEvent): void {
    this.pressed.delete(event.pointerId);
    this.down = null;
  }

  private async release(event: PointerEvent): Promise<void> {
    const { down } = this;
    this.lift(event);
    if (!down || event.button !== 0 || this.stage.busy || this.stage.overHandle || onHandle(event)) return;
    if (Math.hypot(event.clientX - down.x, event.clientY - down.y) > clickPixels) return;
    const picked = await this.pick(event.clientX, event.clientY);
    if (picked === undefined) return;
    set({ pixel: this.stage.pixelAt(event.clientX, event.clientY), point: picked?.position ?? null });
    select(picked ? pathOf(picked.path) : null, event.ctrlKey || event.metaKey || event.shiftKey);
  }

  private move(event: PointerEvent): void {
    this.stage.attention.turnTo(this.stage.placeAt(event.clientX, event.clientY));
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
