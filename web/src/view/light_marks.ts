// A button over the picture for each light: it selects the light, whose handles then move it.
import { Vector3 } from 'three';
import { set, type Store } from '../state/store';
import { poseOfLight } from './light_lines';
import type { ViewCamera } from './camera';

export class LightMarks {
  private readonly marks: HTMLButtonElement[] = [];

  constructor(private readonly element: HTMLElement) {}

  // Marks are there while lights are being edited.
  refresh(state: Store): void {
    const lights = state.rightOpen && state.rightTab === 'lights' ? (state.scene?.lights ?? []) : [];
    while (this.marks.length > lights.length) this.marks.pop()?.remove();
    lights.forEach((light, index) => {
      const mark = (this.marks[index] ??= this.make(index));
      mark.title = light.name || `Light ${index + 1}`;
      mark.setAttribute('aria-label', `Select light ${mark.title}`);
      mark.setAttribute('aria-pressed', String(state.light === index));
      mark.hidden = light.kind === 'directional';
    });
  }

  place(state: Store, camera: ViewCamera, size: { width: number; height: number }): void {
    this.marks.forEach((mark, index) => {
      const light = state.scene?.lights[index];
      if (!light || light.kind === 'directional') return;
      const { position } = poseOfLight(light);
      const behind = position.clone().applyMatrix4(camera.matrixWorldInverse).z >= 0;
      const seen = position.project(camera) as Vector3;
      mark.hidden = behind || Math.abs(seen.x) > 1 || Math.abs(seen.y) > 1;
      mark.style.transform = `translate(${((seen.x + 1) / 2) * size.width}px, ${((1 - seen.y) / 2) * size.height}px) translate(-50%, -50%)`;
    });
  }

  dispose(): void {
    for (const mark of this.marks) mark.remove();
  }

  private make(index: number): HTMLButtonElement {
    const mark = document.createElement('button');
    mark.className = 'light-mark';
    mark.addEventListener('pointerdown', (event) => event.stopPropagation());
    mark.addEventListener('click', () => set({ light: index, selection: [], rightTab: 'lights' }));
    this.element.append(mark);
    return mark;
  }
}
