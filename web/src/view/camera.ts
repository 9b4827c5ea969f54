// Cameras of the scene and of three.js, and the rays between pixels and space. Lengths in the unit of the scene.
import { MathUtils, Matrix4, OrthographicCamera, PerspectiveCamera, Vector3 } from 'three';
import type { Camera, Vector } from '../protocol/messages';

export type WholeCamera = Required<Camera>;
export type ViewCamera = PerspectiveCamera | OrthographicCamera;

export const wholeCamera = (camera: Camera): WholeCamera => ({
  projection: camera.projection ?? 'perspective',
  position: camera.position ?? [0, 0, 5],
  target: camera.target ?? [0, 0, 0],
  up: camera.up ?? [0, 1, 0],
  field_of_view: camera.field_of_view ?? 40,
  height: camera.height ?? 2,
});

export const vector = (v: Vector) => new Vector3(...v);
export const triple = (v: Vector3): Vector => [v.x, v.y, v.z];

export type Frame3 = { position: Vector3; right: Vector3; up: Vector3; forward: Vector3 };

export function frameOf(camera: WholeCamera): Frame3 {
  const position = vector(camera.position);
  const forward = vector(camera.target).sub(position).normalize();
  const right = forward.clone().cross(vector(camera.up));
  if (right.lengthSq() < 1e-20) right.crossVectors(forward, Math.abs(forward.y) < 0.9 ? new Vector3(0, 1, 0) : new Vector3(1, 0, 0));
  right.normalize();
  return { position, right, up: right.clone().cross(forward), forward };
}

// Half the height of what is seen at distance 1 (perspective), or at any (orthographic).
export const halfHeight = (camera: WholeCamera) => (camera.projection === 'perspective' ? Math.tan(MathUtils.degToRad(camera.field_of_view) / 2) : camera.height / 2);

export function makeCamera(camera: WholeCamera, aspect: number): ViewCamera {
  const half = halfHeight(camera);
  const made =
    camera.projection === 'perspective' ? new PerspectiveCamera(camera.field_of_view, aspect, 0.01, 100) : new OrthographicCamera(-half * aspect, half * aspect, half, -half, 0.01, 100);
  const { position, right, up, forward } = frameOf(camera);
  made.position.copy(position);
  made.up.set(...camera.up);
  made.quaternion.setFromRotationMatrix(new Matrix4().makeBasis(right, up, forward.clone().negate()));
  return made;
}

// The camera as the program is told it. The target is put at that distance along the view.
export function readCamera(made: ViewCamera, distance: number, fieldOfView: number): WholeCamera {
  const forward = new Vector3(0, 0, -1).applyQuaternion(made.quaternion);
  const up = new Vector3(0, 1, 0).applyQuaternion(made.quaternion);
  const orthographic = made instanceof OrthographicCamera;
  return {
    projection: orthographic ? 'orthographic' : 'perspective',
    position: triple(made.position),
    target: triple(forward.multiplyScalar(distance).add(made.position)),
    up: triple(up),
    field_of_view: fieldOfView,
    height: orthographic ? (made.top - made.bottom) / made.zoom : 2,
  };
}

// The ray through a place of the picture, x and y from 0 to 1 from the upper left.
export function rayThrough(camera: WholeCamera, aspect: number, x: number, y: number): { origin: Vector3; direction: Vector3 } {
  const { position, right, up, forward } = frameOf(camera);
  const half = halfHeight(camera);
  const aside = right.multiplyScalar((2 * x - 1) * half * aspect).addScaledVector(up, (1 - 2 * y) * half);
  return camera.projection === 'perspective' ? { origin: position, direction: forward.add(aside).normalize() } : { origin: position.add(aside), direction: forward };
}
