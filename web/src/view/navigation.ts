// Moving through the scene as in CAD: orbit around the point under the pointer, pan, zoom to the pointer, standard views. camera-controls does the motion; here is what it moves around,
// and the two kinds of projection.
import CameraControls from 'camera-controls';
import { Box3, MathUtils, Matrix4, OrthographicCamera, PerspectiveCamera, Quaternion, Raycaster, Sphere, Spherical, Vector2, Vector3, Vector4 } from 'three';
import type { Share } from './free_share';
import { makeCamera, readCamera, triple, vector, wholeCamera, type ViewCamera, type WholeCamera } from './camera';
import type { Camera } from '../protocol/messages';

CameraControls.install({ THREE: { Vector2, Vector3, Vector4, Quaternion, Matrix4, Spherical, Box3, Sphere, Raycaster } });

const { ACTION } = CameraControls;

export type StandardView = 'front' | 'back' | 'left' | 'right' | 'top' | 'bottom' | 'isometric';

const directions: Record<StandardView, [number, number, number]> = {
  front: [0, 0, 1],
  back: [0, 0, -1],
  left: [-1, 0, 0],
  right: [1, 0, 0],
  top: [0, 1, 0],
  bottom: [0, -1, 0],
  isometric: [1, 0.8, 1],
};

// Share of the frame that a fitted model fills.
const filled = 0.86;

export class Navigation {
  readonly controls: CameraControls;
  camera: ViewCamera = new PerspectiveCamera(40, 1, 0.01, 100);
  private aspect = 1;
  private fieldOfView = 40;
  private bounds = new Sphere(new Vector3(), 1);

  constructor(element: HTMLElement, private readonly changed: () => void) {
    this.controls = new CameraControls(this.camera, element);
    this.controls.draggingSmoothTime = 0;
    this.controls.smoothTime = 0.08;
    this.controls.dollyToCursor = true;
    this.controls.dollySpeed = 0.6;
    this.controls.touches.three = ACTION.TOUCH_TRUCK;
    this.controls.addEventListener('controlend', () => this.settle());
    for (const event of ['wake', 'control', 'update', 'controlstart'] as const) this.controls.addEventListener(event, this.changed);
    this.assignActions();
  }

  dispose(): void {
    this.controls.dispose();
  }

  // Moves on by so many seconds; true while there is motion.
  step(seconds: number): boolean {
    const moving = this.controls.update(seconds);
    // Turned about a point aside, the camera is put beside it along the axes that it had before the turn: once more, along those of now.
    if (this.controls.getFocalOffset(new Vector3(), false).lengthSq() > 0) this.controls.update(0);
    return moving;
  }

  resize(aspect: number): void {
    this.aspect = aspect;
    if (this.camera instanceof PerspectiveCamera) this.camera.aspect = aspect;
    else {
      this.camera.right = this.camera.top * aspect;
      this.camera.left = -this.camera.right;
    }
    this.updateDepth();
    this.changed();
  }

  setBounds(box: Box3): void {
    box.getBoundingSphere(this.bounds);
    if (!(this.bounds.radius > 0)) this.bounds.set(new Vector3(), 1);
    this.controls.minDistance = this.bounds.radius * 1e-5;
    this.updateDepth();
  }

  get(): WholeCamera {
    const distance = Math.max(this.controls.distance, this.bounds.radius * 1e-4);
    return readCamera(this.camera, distance, this.fieldOfView);
  }

  // Jumps.
  set(camera: Camera): void {
    const whole = wholeCamera(camera);
    this.fieldOfView = whole.field_of_view;
    this.camera = makeCamera(whole, this.aspect);
    this.controls.camera = this.camera;
    // A camera that rolls turns about its own up.
    this.controls.updateCameraUp();
    this.assignActions();
    this.place(vector(whole.position), vector(whole.target));
    this.changed();
  }

  // Dragging with the left button (or a pen) pans instead of turning.
  leftPans(pans: boolean): void {
    this.controls.mouseButtons.left = pans ? ACTION.TRUCK : ACTION.ROTATE;
  }

  // Turns and zooms about that point from now on; the view stays.
  pivotAt(point: Vector3): void {
    this.controls.setOrbitPoint(point.x, point.y, point.z);
  }

  // Puts the target at the depth of the point, so that zooming comes to it, and not before nor behind.
  zoomTo(point: Vector3): void {
    const forward = new Vector3(0, 0, -1).applyQuaternion(this.camera.quaternion);
    const depth = point.clone().sub(this.camera.position).dot(forward);
    if (depth > 0) this.place(this.camera.position.clone(), forward.multiplyScalar(depth).add(this.camera.position));
  }

  get pivot(): Vector3 {
    return this.controls.getTarget(new Vector3(), false);
  }

  // Shows all of the box in that share of the view.
  fit(box: Box3, share: Share, animated = true): void {
    if (box.isEmpty()) return;
    const sphere = box.getBoundingSphere(new Sphere());
    sphere.radius = Math.max(sphere.radius, 1e-9) / filled / this.shareOfSmaller(share);
    void this.controls.fitToSphere(sphere, animated);
    void this.controls.setFocalOffset(0, 0, 0, animated);
  }

  // The nearest place at the same depth that is seen in that share of the view; what lies behind the viewer, or close to him, comes halfway to the target.
  intoView(place: Vector3, share: Share): Vector3 {
    this.camera.updateMatrixWorld();
    const own = place.clone().applyMatrix4(this.camera.matrixWorldInverse);
    if (this.camera instanceof PerspectiveCamera && own.z > -0.1 * this.controls.distance) own.z = -0.5 * this.controls.distance;
    const seen = own.applyMatrix4(this.camera.projectionMatrix);
    seen.x = MathUtils.clamp(seen.x, -Math.max(share.width, 0), Math.max(share.width, 0));
    seen.y = MathUtils.clamp(seen.y, -Math.max(share.height, 0), Math.max(share.height, 0));
    return seen.unproject(this.camera);
  }

  // Where the box is about within the view, but not within that share of it: goes back until it is.
  stepBack(box: Box3, share: Share): void {
    this.camera.updateMatrixWorld();
    const far = { width: 0, height: 0 };
    for (let i = 0; i < 8; i++) {
      const corner = new Vector3(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z).project(this.camera);
      far.width = Math.max(far.width, Math.abs(corner.x));
      far.height = Math.max(far.height, Math.abs(corner.y));
    }
    // The corners of a box may lie outside where what is in it does not; and what was framed for a wide view is wider than a narrow one.
    const narrow = Math.max(16 / 9 / this.aspect, 1);
    const factor = Math.max(Math.min(far.width, filled * narrow) / share.width, Math.min(far.height, filled) / share.height);
    if (far.width > 1.6 * narrow || far.height > 1.6 || factor <= 1) return;
    if (this.camera instanceof OrthographicCamera) void this.controls.zoomTo(this.camera.zoom / factor, false);
    else void this.controls.dollyTo(this.controls.distance * factor, false);
    this.controls.update(0);
    this.changed();
  }

  // Of the share of the narrower side: that is the one that a sphere is fitted to.
  private shareOfSmaller(share: Share): number {
    return Math.min(share.width * Math.max(this.aspect, 1), share.height * Math.max(1 / this.aspect, 1));
  }

  look(from: StandardView, share: Share): void {
    const [x, y, z] = directions[from];
    const target = this.bounds.center;
    const distance = this.controls.distance;
    const position = new Vector3(x, y, z).normalize().multiplyScalar(distance).add(target);
    if (this.camera.up.y !== 1) this.upright();
    void this.controls.setFocalOffset(0, 0, 0, true);
    void this.controls.setLookAt(position.x, position.y, position.z, target.x, target.y, target.z, true);
    void this.controls.fitToSphere(new Sphere(target.clone(), this.bounds.radius / filled / this.shareOfSmaller(share)), true);
  }

  turn(azimuthDegrees: number, polarDegrees: number, animated = true): void {
    void this.controls.rotate(MathUtils.degToRad(azimuthDegrees), MathUtils.degToRad(polarDegrees), animated);
  }

  zoomBy(factor: number): void {
    if (this.camera instanceof OrthographicCamera) void this.controls.zoomTo(this.camera.zoom * factor, true);
    else void this.controls.dollyTo(this.controls.distance / factor, true);
  }

  truck(x: number, y: number): void {
    const half = this.camera instanceof OrthographicCamera ? this.camera.top / this.camera.zoom : Math.tan(MathUtils.degToRad(this.fieldOfView) / 2) * this.controls.distance;
    void this.controls.truck(x * half, y * half, true);
  }

  // The same view of the pivot by the other projection.
  setOrthographic(orthographic: boolean): void {
    const now = this.get();
    if ((now.projection === 'orthographic') === orthographic) return;
    const tangent = Math.tan(MathUtils.degToRad(this.fieldOfView) / 2);
    if (orthographic) {
      this.set({ ...now, up: triple(this.camera.up), projection: 'orthographic', height: 2 * tangent * this.controls.distance });
    } else {
      const forward = vector(now.target).sub(vector(now.position)).normalize();
      const position = vector(now.target).addScaledVector(forward, -now.height / (2 * tangent));
      this.set({ ...now, up: triple(this.camera.up), projection: 'perspective', position: triple(position) });
    }
  }

  setFieldOfView(degrees: number): void {
    this.set({ ...this.get(), up: triple(this.camera.up), field_of_view: degrees });
  }

  private upright(): void {
    this.camera.up.set(0, 1, 0);
    this.controls.updateCameraUp();
  }

  // After a turn about a point aside, the target comes back into the middle of the view, at the depth of the point.
  private settle(): void {
    const offset = this.controls.getFocalOffset(new Vector3(), false);
    if (offset.lengthSq() === 0) return;
    const forward = new Vector3(0, 0, -1).applyQuaternion(this.camera.quaternion);
    const depth = this.pivot.sub(this.camera.position).dot(forward);
    if (depth > 0) this.place(this.camera.position.clone(), forward.multiplyScalar(depth).add(this.camera.position));
  }

  private place(position: Vector3, target: Vector3): void {
    void this.controls.setFocalOffset(0, 0, 0, false);
    void this.controls.setLookAt(position.x, position.y, position.z, target.x, target.y, target.z, false);
    this.controls.update(0);
    this.updateDepth();
  }

  // What is drawn over the picture lies within the bounds or near them.
  private updateDepth(): void {
    const distance = this.camera.position.distanceTo(this.bounds.center);
    this.camera.far = distance + this.bounds.radius * 100;
    this.camera.near = this.camera instanceof OrthographicCamera ? -this.camera.far : Math.max(this.camera.far * 1e-5, distance * 1e-3);
    this.camera.updateProjectionMatrix();
  }

  private assignActions(): void {
    const orthographic = this.camera instanceof OrthographicCamera;
    this.controls.mouseButtons.left = ACTION.ROTATE;
    this.controls.mouseButtons.right = ACTION.TRUCK;
    this.controls.mouseButtons.middle = ACTION.TRUCK;
    this.controls.mouseButtons.wheel = orthographic ? ACTION.ZOOM : ACTION.DOLLY;
    this.controls.touches.one = ACTION.TOUCH_ROTATE;
    this.controls.touches.two = orthographic ? ACTION.TOUCH_ZOOM_TRUCK : ACTION.TOUCH_DOLLY_TRUCK;
  }
}


