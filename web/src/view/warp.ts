// How a picture that was seen by one camera looks to another: the plane through the pivot that faces the old camera carries the picture, and the new camera sees the plane. That is a
// homography, which the browser does as a CSS transform; near the pivot it is exact, and it stands only until the first pixels of the new camera come, some hundredths of a second.
import type { Vector3 } from 'three';
import { frameOf, halfHeight, type WholeCamera } from './camera';

export type Size = { width: number; height: number };

type Homogeneous = [number, number, number];

// The CSS transform of an element of the size of the picture, in pixels, to a view in CSS pixels, both with their origin in the upper left corner.
export function warp(from: WholeCamera, picture: Size, to: WholeCamera, view: Size, pivot: Vector3): string {
  return sameCamera(from, to) ? scaled(picture, view) : (homography(from, picture, to, view, pivot) ?? scaled(picture, view));
}

const scaled = (picture: Size, view: Size) => `scale(${view.width / picture.width}, ${view.height / picture.height})`;

// Thousandths of a pixel are not seen.
const unseen = 1e-6; // of the distance, and of radians

export function sameCamera(a: WholeCamera, b: WholeCamera): boolean {
  if (a.projection !== b.projection || Math.abs(halfHeight(a) - halfHeight(b)) > unseen * halfHeight(a)) return false;
  const near = (p: number[], q: number[], tolerance: number) => p.every((x, i) => Math.abs(x - q[i]) <= tolerance);
  const scale = Math.hypot(...a.position.map((x, i) => x - a.target[i]));
  const fa = frameOf(a);
  const fb = frameOf(b);
  return near(a.position, b.position, scale * unseen) && near(fa.forward.toArray(), fb.forward.toArray(), unseen) && near(fa.up.toArray(), fb.up.toArray(), unseen);
}

// Null where the plane passes behind the new camera.
function homography(from: WholeCamera, picture: Size, to: WholeCamera, view: Size, pivot: Vector3): string | null {
  const old = frameOf(from);
  const depth = Math.max(pivot.clone().sub(old.position).dot(old.forward), 1e-6 * Math.hypot(...from.position.map((x, i) => x - from.target[i])));
  // A pixel (u, v) of the old picture is the point origin + u * across + v * down of the plane.
  const half = halfHeight(from) * (from.projection === 'perspective' ? depth : 1);
  const halfWidth = (half * picture.width) / picture.height;
  const origin = old.position.clone().addScaledVector(old.forward, depth).addScaledVector(old.right, -halfWidth).addScaledVector(old.up, half);
  const across = old.right.clone().multiplyScalar((2 * halfWidth) / picture.width);
  const down = old.up.clone().multiplyScalar((-2 * half) / picture.height);

  const now = frameOf(to);
  const nowHalf = halfHeight(to);
  const nowHalfWidth = (nowHalf * view.width) / view.height;
  const seen = (v: Vector3, isPoint: boolean): Homogeneous => {
    const q = isPoint ? v.clone().sub(now.position) : v;
    const w = to.projection === 'perspective' ? q.dot(now.forward) : isPoint ? 1 : 0;
    return [((q.dot(now.right) / nowHalfWidth + w) / 2) * view.width, ((w - q.dot(now.up) / nowHalf) / 2) * view.height, w];
  };
  const h = [seen(across, false), seen(down, false), seen(origin, true)];
  const corners = [[0, 0], [picture.width, 0], [0, picture.height], [picture.width, picture.height]];
  const least = Math.min(...corners.map(([u, v]) => h[0][2] * u + h[1][2] * v + h[2][2]));
  if (!(least > 1e-3 * h[2][2])) return null;
  const k = 1 / h[2][2];
  const [[a, d, g], [b, e, i], [c, f]] = h.map((column) => column.map((x) => x * k));
  return `matrix3d(${[a, d, 0, g, b, e, 0, i, 0, 0, 1, 0, c, f, 0, 1].join(',')})`;
}
