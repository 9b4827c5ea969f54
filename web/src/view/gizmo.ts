// The handles that move and turn what is selected, parts and lights. three's TransformControls turns a stand-in; every step of the drag becomes an edit, and the whole drag is one undo.
import { Matrix4, Object3D, Quaternion, Vector3 } from 'three';
import { TransformControls } from 'three/examples/jsm/controls/TransformControls.js';
import { callName, Drag } from '../state/edits';
import { boxOf, leafOf, objectAt, parentOf, rowsOfMatrix, worldOf } from '../state/tree';
import type { Store } from '../state/store';
import type { Outgoing } from '../protocol/messages';
import { poseOfLight } from './light_lines';
import { triple, type ViewCamera } from './camera';

const down = new Vector3(0, -1, 0);

export class Gizmo {
  readonly controls: TransformControls;
  // What three's handles hold; it stands in the scene that is drawn over the picture.
  readonly proxy = new Object3D();
  private drag: Drag | null = null;
  private toEdit: (() => Outgoing) | null = null;

  // dragging: told true and false when a drag of the handles begins and ends; changed: when they look different.
  constructor(camera: ViewCamera, element: HTMLElement, dragging: (now: boolean) => void, changed: () => void) {
    this.controls = new TransformControls(camera, element);
    this.controls.size = 0.8;
    this.controls.addEventListener('change', changed);
    this.controls.addEventListener('dragging-changed', (event) => {
      const now = event.value as boolean;
      this.drag = now ? new Drag(this.controls.mode === 'rotate' ? 'Rotate' : 'Move') : null;
      dragging(now);
    });
    this.controls.addEventListener('objectChange', () => {
      if (this.drag && this.toEdit) void this.drag.send(this.toEdit());
    });
  }

  get dragging(): boolean {
    return this.controls.dragging;
  }

  // The handle that the pointer is on, as three calls it: X, XY, ...; null if on none.
  get handle(): string | null {
    return this.controls.object === undefined ? null : this.controls.axis;
  }

  // Where the handles stand and what they do, from the state of the page.
  show(state: Store, camera: ViewCamera): void {
    this.controls.camera = camera;
    if (this.dragging) return;
    this.toEdit = null;
    const { scene } = state;
    if (scene && state.light !== null && scene.lights[state.light]) this.holdLight(state, state.light);
    else if (scene && state.selection.length > 0 && state.tool !== 'select') this.holdPart(state, state.selection[state.selection.length - 1]);
    if (this.toEdit) this.controls.attach(this.proxy);
    else this.controls.detach();
    if (!scene?.bounds) return;
    const size = boxOf(scene.bounds).getSize(new Vector3()).length();
    this.controls.setTranslationSnap(state.snap ? snapOf(size) : null);
    this.controls.setRotationSnap(state.snap ? Math.PI / 12 : null);
  }

  dispose(): void {
    this.controls.dispose();
  }

  private holdPart(state: Store, path: string): void {
    const scene = state.scene;
    const object = scene && objectAt(scene, leafOf(path));
    if (!scene || !object) return;
    const above = parentOf(path);
    const parent = above === null ? new Matrix4() : worldOf(scene, above);
    const world = worldOf(scene, path);
    // The handles stand in the middle of the part, which they turn it about.
    const middle = object.bounds ? boxOf(object.bounds).getCenter(new Vector3()) : new Vector3();
    this.controls.setMode(state.tool === 'rotate' ? 'rotate' : 'translate');
    this.controls.setSpace('world');
    this.proxy.position.copy(middle.clone().applyMatrix4(world));
    this.proxy.quaternion.identity();
    this.proxy.scale.set(1, 1, 1);
    this.proxy.updateMatrixWorld();
    const start = this.proxy.matrixWorld.clone().invert();
    const back = parent.clone().invert();
    this.toEdit = () => {
      this.proxy.updateMatrixWorld();
      const moved = back.clone().multiply(this.proxy.matrixWorld).multiply(start).multiply(world);
      return { move: { object: object.index, transform: { matrix: rowsOfMatrix(moved) } } };
    };
  }

  private holdLight(state: Store, index: number): void {
    const light = state.scene?.lights[index];
    if (!light || !state.scene) return;
    const { position, direction } = poseOfLight(light);
    const name = callName(light, index);
    const far = light.kind === 'directional';
    const turning = far || state.tool === 'rotate';
    this.controls.setMode(turning ? 'rotate' : 'translate');
    this.controls.setSpace(turning ? 'local' : 'world');
    this.proxy.position.copy(far && state.scene.bounds ? boxOf(state.scene.bounds).getCenter(new Vector3()) : position);
    this.proxy.quaternion.copy(new Quaternion().setFromUnitVectors(down, direction));
    this.toEdit = () =>
      turning
        ? { set: { [`light.${name}.direction`]: triple(down.clone().applyQuaternion(this.proxy.quaternion)) } }
        : { set: { [`light.${name}.position`]: triple(this.proxy.position) } };
  }
}

// A round step of about a hundredth of the model.
export function snapOf(size: number): number {
  const power = 10 ** Math.floor(Math.log10(size / 50));
  return [1, 2, 5, 10].map((k) => k * power).find((step) => step >= size / 100) ?? power;
}
