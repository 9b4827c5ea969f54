// The outline of a light: its extent, where it shines, its cone.
import { MathUtils, Vector3 } from 'three';
import type { Values, Vector } from '../protocol/messages';

const around = 48;

export type LightPose = { position: Vector3; direction: Vector3; up: Vector3 };

export const poseOfLight = (light: Values): LightPose => ({
  position: new Vector3(...((light.position as Vector | undefined) ?? [0, 0, 0])),
  direction: new Vector3(...((light.direction as Vector | undefined) ?? [0, -1, 0])).normalize(),
  up: new Vector3(...((light.up as Vector | undefined) ?? [0, 1, 0])).normalize(),
});

// With the directions in which its width and its height run.
export function axesOfLight(light: Values): LightPose & { right: Vector3; above: Vector3 } {
  const pose = poseOfLight(light);
  const right = pose.direction.clone().cross(pose.up);
  if (right.lengthSq() < 1e-12) right.crossVectors(pose.direction, new Vector3(1, 0, 0));
  if (right.lengthSq() < 1e-12) right.set(0, 0, 1);
  right.normalize();
  return { ...pose, right, above: right.clone().cross(pose.direction) };
}

// Pairs of points; reach: how far rays are drawn.
export function lightLines(light: Values, reach: number): number[] {
  const { position, direction, right, above } = axesOfLight(light);
  const points: number[] = [];
  const line = (a: Vector3, b: Vector3) => points.push(...a.toArray(), ...b.toArray());
  const circle = (center: Vector3, u: Vector3, v: Vector3, radius: number) => {
    const at = (i: number) => center.clone().addScaledVector(u, radius * Math.cos((2 * Math.PI * i) / around)).addScaledVector(v, radius * Math.sin((2 * Math.PI * i) / around));
    for (let i = 0; i < around; i++) line(at(i), at(i + 1));
  };
  const number = (name: string, otherwise: number) => (typeof light[name] === 'number' ? light[name] : otherwise);
  const kind = light.kind ?? 'point';
  if (kind === 'rectangle') {
    const [w, h] = [number('width', 1) / 2, number('height', 1) / 2];
    const at = (x: number, y: number) => position.clone().addScaledVector(right, x * w).addScaledVector(above, y * h);
    line(at(-1, -1), at(1, -1));
    line(at(1, -1), at(1, 1));
    line(at(1, 1), at(-1, 1));
    line(at(-1, 1), at(-1, -1));
  } else if (kind === 'disk') circle(position, right, above, number('radius', 0.5));
  else if (kind === 'sphere') {
    for (const [u, v] of [[right, above], [right, direction], [above, direction]]) circle(position, u, v, number('radius', 0.5));
  }
  const outer = number('outer_angle', 180);
  if (kind !== 'sphere' && (kind !== 'point' || outer < 180)) line(position, position.clone().addScaledVector(direction, reach));
  if (outer < 90 && kind !== 'directional') {
    const radius = reach * Math.tan(MathUtils.degToRad(outer));
    const end = position.clone().addScaledVector(direction, reach);
    circle(end, right, above, radius);
    const inner = number('inner_angle', 0);
    if (inner > 0 && inner < outer) circle(end, right, above, reach * Math.tan(MathUtils.degToRad(inner)));
    for (const [u, sign] of [[right, 1], [right, -1], [above, 1], [above, -1]] as const) line(position, end.clone().addScaledVector(u, sign * radius));
  }
  return points;
}
