// The view as a whole: the picture, the camera that moves over it, and what is drawn over both. One loop by the display's beat, which rests when nothing moves.
import { Box3, Vector3 } from 'three';
import { get, set, useStore, type Store } from '../state/store';
import { drawFramesWith, send } from '../state/session';
import { boxOf, leafOf, objectAt, worldBox, worldOf } from '../state/tree';
import { Attention } from './attention';
import { boxLines, Overlay } from './overlay';
import { wholeCamera, type WholeCamera } from './camera';
import { Gizmo } from './gizmo';
import { lightLines } from './light_lines';
import { LightHandles } from './light_handles';
import { LightMarks } from './light_marks';
import { Navigation, type StandardView } from './navigation';
import { Picture } from './picture';
import { Pointer } from './pointer';
import { ViewCube } from './view_cube';
import { freeShare } from './free_share';
import { sameCamera, warp } from './warp';
import type { Camera, Scene } from '../protocol/messages';

const colors = { selected: 0xf5b942, hovered: 0xffffff, light: 0xffe08a };
const turntableDegreesPerSecond = 20;
const handleReach = 0.12; // of the height of the view: what three's handles take to each side
const usualFrame = 1 / 60; // seconds

// What of the state is drawn over the picture.
const drawnFrom = ({ scene, selection, hovered, tool, light, snap, rightOpen, rightTab }: Store) => [scene?.objects, scene?.lights, scene?.bounds, selection, hovered, tool, light, snap, rightOpen, rightTab];

export class Stage {
  readonly navigation: Navigation;
  readonly picture: Picture;
  readonly attention = new Attention(() => window.devicePixelRatio);
  private readonly overlay: Overlay;
  private readonly gizmo: Gizmo;
  private readonly cube: ViewCube;
  private readonly marks: LightMarks;
  private readonly lightHandles: LightHandles;
  private readonly pointer: Pointer;
  private readonly observer: ResizeObserver;
  private readonly unsubscribe: () => void;
  private size = { width: 1, height: 1 };
  private looks = 0;
  private cameras = new Map<number, WholeCamera>(); // by the number of `look`s
  private told: WholeCamera | null = null;
  private request = 0;
  private time = 0;

  constructor(private readonly element: HTMLElement, private readonly cubePlace: HTMLElement) {
    this.picture = new Picture((frame) => {
      send({ shown: frame.number });
      for (const look of this.cameras.keys()) if (look < frame.look) this.cameras.delete(look);
      this.element.dataset.frames = String(this.picture.frames);
      this.element.dataset.converged = String(frame.converged);
      this.wake();
    });
    const overlayCanvas = document.createElement('canvas');
    overlayCanvas.className = 'overlay';
    element.append(this.picture.canvas, overlayCanvas);
    this.overlay = new Overlay(overlayCanvas);
    const wake = () => this.wake();
    const parts: { navigation?: Navigation } = {};
    // Before the navigation, so that the handles get the pointer first.
    this.gizmo = new Gizmo(new Navigation(document.createElement('div'), () => undefined).camera, element, (dragging) => {
      if (parts.navigation) parts.navigation.controls.enabled = !dragging;
      if (!dragging) this.refresh(get());
    }, () => {
      this.overlay.changed();
      this.wake();
    });
    this.navigation = parts.navigation = new Navigation(element, wake);
    this.overlay.add(this.gizmo.proxy);
    this.overlay.add(this.gizmo.controls.getHelper());
    this.cube = new ViewCube(cubePlace, this.navigation, wake);
    this.marks = new LightMarks(element);
    this.lightHandles = new LightHandles(element, () => this.navigation.get());
    this.pointer = new Pointer(element, this);
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(element);
    this.unsubscribe = useStore.subscribe((now, before) => this.follow(now, before));
    drawFramesWith((data) => this.picture.receive(data));
    this.resize();
    if (get().connection === 'open') this.takeUp();
    if (get().scene) this.takeScene(get());
  }

  dispose(): void {
    cancelAnimationFrame(this.request);
    drawFramesWith(null);
    this.unsubscribe();
    this.observer.disconnect();
    this.pointer.dispose();
    this.attention.dispose();
    this.marks.dispose();
    this.lightHandles.dispose();
    this.cube.dispose();
    this.gizmo.dispose();
    this.navigation.dispose();
    this.overlay.dispose();
    this.element.replaceChildren();
  }

  get busy(): boolean {
    return this.gizmo.dragging;
  }

  get overHandle(): boolean {
    return this.gizmo.handle !== null;
  }

  // A place of the page in the view, CSS pixels.
  placeAt(clientX: number, clientY: number): { x: number; y: number } {
    const rect = this.element.getBoundingClientRect();
    return { x: clientX - rect.left, y: clientY - rect.top };
  }

  // A place of the page as pixel of the picture; null outside.
  pixelAt(clientX: number, clientY: number): { x: number; y: number } | null {
    const rect = this.element.getBoundingClientRect();
    const x = Math.floor(((clientX - rect.left) / rect.width) * this.pixels.width);
    const y = Math.floor(((clientY - rect.top) / rect.height) * this.pixels.height);
    return x < 0 || y < 0 || x >= this.pixels.width || y >= this.pixels.height ? null : { x, y };
  }

  get pixels(): { width: number; height: number } {
    const ratio = window.devicePixelRatio;
    return { width: Math.max(1, Math.round(this.size.width * ratio)), height: Math.max(1, Math.round(this.size.height * ratio)) };
  }

  // Fits what is selected, or everything.
  fit(all = false): void {
    const { scene, selection } = get();
    if (!scene) return;
    const box = new Box3();
    if (!all) for (const path of selection) box.union(worldBox(scene, path) ?? new Box3());
    if (box.isEmpty() && scene.bounds) box.copy(boxOf(scene.bounds));
    this.navigation.fit(box, freeShare(this.element));
    this.wake();
  }

  // The nearest place at the same depth that neither a panel nor the cube covers, with room about it for the handles of what stands there.
  intoSight(place: Vector3): Vector3 {
    const share = freeShare(this.element);
    const reach = handleReach * this.size.height;
    const room = { width: share.width - (2 * reach) / this.size.width, height: share.height - 2 * handleReach };
    const seen = this.navigation.intoView(place, room);
    const { x, y } = seen.clone().project(this.navigation.camera);
    const cube = this.cubePlace.getBoundingClientRect();
    const view = this.element.getBoundingClientRect();
    const left = ((cube.left - view.left - reach / 2) / view.width) * 2 - 1;
    const bottom = 1 - ((cube.bottom - view.top + reach / 2) / view.height) * 2;
    return x > left && y > bottom ? this.navigation.intoView(seen, { ...room, width: left }) : seen;
  }

  look(from: StandardView): void {
    this.navigation.look(from, freeShare(this.element));
    this.wake();
  }

  wake(): void {
    if (this.request === 0) this.request = requestAnimationFrame((now) => this.beat(now));
  }

  private beat(now: number): void {
    this.request = 0;
    // What begins to move does so in this very frame.
    const seconds = this.time === 0 ? usualFrame : Math.min((now - this.time) / 1000, 0.1);
    const state = get();
    if (state.turntable) this.navigation.turn(turntableDegreesPerSecond * seconds, 0, false);
    const moving = this.navigation.step(seconds);
    const turning = this.cube.draw();
    this.tellCamera();
    this.placePicture();
    this.gizmo.controls.camera = this.navigation.camera;
    this.overlay.render(this.navigation.camera, this.gizmo.controls.object !== undefined);
    this.element.dataset.handle = this.gizmo.handle ?? '';
    this.marks.place(state, this.navigation.camera, this.size);
    this.lightHandles.place(this.navigation.camera, this.size);
    this.time = moving || turning || state.turntable ? now : 0;
    if (this.time !== 0) this.wake();
  }

  // Tells the program a camera that it does not know yet. One that differs by less than can be seen, as motion does that comes to its end, is none.
  private tellCamera(): void {
    if (!get().scene) return;
    const camera = this.navigation.get();
    if (this.told && sameCamera(this.told, camera)) return;
    if (!send({ look: camera })) return;
    this.told = camera;
    this.cameras.set(++this.looks, camera);
  }

  // The picture of an old camera, as the camera of now would see it.
  private placePicture(): void {
    const { canvas, look } = this.picture;
    const seenBy = look === null ? undefined : this.cameras.get(look);
    const to = this.navigation.get();
    const picture = { width: canvas.width, height: canvas.height };
    canvas.style.transform = warp(seenBy ?? to, picture, to, this.size, this.navigation.pivot);
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.element;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.size = { width: clientWidth, height: clientHeight };
    this.overlay.resize(clientWidth, clientHeight, window.devicePixelRatio);
    this.navigation.resize(clientWidth / clientHeight);
    send({ view: this.pixels });
    this.wake();
  }

  // A connection that is new, or there again: the program counts from 0.
  private takeUp(): void {
    this.looks = 0;
    this.cameras.clear();
    this.told = null;
    this.picture.forget();
    this.attention.forget();
    send({ view: this.pixels });
  }

  private takeScene(state: Store): void {
    const { scene } = state;
    if (!scene) return;
    if (scene.bounds) this.navigation.setBounds(boxOf(scene.bounds));
    this.navigation.set(scene.camera);
    // Until the camera is moved, the picture is seen by the one of the scene.
    const camera = this.navigation.get();
    this.cameras.set(this.looks, camera);
    this.told = camera;
    this.makeRoom(scene);
    set({ orthographic: scene.camera.projection === 'orthographic' });
    this.refresh(state);
  }

  // A model that was framed for the whole window is stepped back from, once, so far that panels do not cover it.
  private makeRoom(scene: Scene): void {
    const seen = `crescente.seen ${get().welcome?.session} ${scene.file}`;
    if (!scene.bounds || sessionStorage.getItem(seen) !== null) return;
    sessionStorage.setItem(seen, '');
    this.navigation.stepBack(boxOf(scene.bounds), freeShare(this.element));
  }

  // Whether it is a camera that the program has from here: then the view is there already, or beyond.
  private isTold(camera: Camera): boolean {
    const whole = wholeCamera(camera);
    return [...this.cameras.values()].some((one) => sameCamera(one, whole));
  }

  private follow(now: Store, before: Store): void {
    if (now.connection === 'open' && before.connection !== 'open') this.takeUp();
    if (now.scene && now.scene.camera !== before.scene?.camera && !this.isTold(now.scene.camera)) this.takeScene(now);
    else if (drawnFrom(now).some((part, i) => part !== drawnFrom(before)[i])) this.refresh(now);
    if (now.turntable && !before.turntable) this.wake();
    if (now.orthographic !== before.orthographic && now.scene) this.navigation.setOrthographic(now.orthographic);
  }

  // Boxes, outlines and handles, from the state of the page.
  private refresh(state: Store): void {
    const { scene } = state;
    const lines = (paths: string[]) =>
      paths.flatMap((path) => {
        const bounds = scene && objectAt(scene, leafOf(path))?.bounds;
        return scene && bounds ? boxLines(boxOf(bounds), worldOf(scene, path)) : [];
      });
    if (scene?.bounds) this.navigation.setBounds(boxOf(scene.bounds));
    this.overlay.setLines('selected', lines(state.selection), colors.selected, 0.95);
    this.overlay.setLines('hovered', state.hovered && !state.selection.includes(state.hovered) ? lines([state.hovered]) : [], colors.hovered, 0.75);
    const light = scene && state.light !== null ? scene.lights[state.light] : undefined;
    const reach = scene?.bounds ? boxOf(scene.bounds).getSize(new Vector3()).length() / 2 : 1;
    this.overlay.setLines('light', light && light.kind !== 'directional' ? lightLines(light, reach) : [], colors.light, 0.9);
    this.gizmo.show(state, this.navigation.camera);
    this.overlay.changed();
    this.marks.refresh(state);
    this.lightHandles.refresh(state);
    this.wake();
  }
}
