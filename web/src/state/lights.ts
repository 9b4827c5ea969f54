// New lights: above the model and to its front left, where one sees them, aimed at its middle, bright enough to be seen at once.
import { Vector3 } from 'three';
import type { Named, Scene } from '../protocol/messages';
import { boxOf } from './tree';

export const lightKinds = [
  { kind: 'point', title: 'Point' },
  { kind: 'spot', title: 'Spot, with a cone' },
  { kind: 'rectangle', title: 'Rectangle (soft box)' },
  { kind: 'disk', title: 'Disk' },
  { kind: 'sphere', title: 'Sphere' },
  { kind: 'directional', title: 'Directional (sun)' },
];

const metres: Record<string, number> = { um: 1e-6, mm: 1e-3, cm: 1e-2, m: 1, km: 1e3, in: 0.0254, ft: 0.3048 };

// intoSight: the nearest place like that one which is seen.
export function newLight(scene: Scene, kind: string, intoSight: (place: Vector3) => Vector3): Named {
  const box = scene.bounds ? boxOf(scene.bounds) : null;
  const middle = box ? box.getCenter(new Vector3()) : new Vector3();
  const radius = box ? box.getSize(new Vector3()).length() / 2 : 1;
  const usual = new Vector3(-0.9, 1.5, 1.2).multiplyScalar(radius).add(middle);
  const offset = (kind === 'directional' ? usual : intoSight(usual)).clone().sub(middle);
  const distance = offset.length() * (metres[scene.unit] ?? 1);
  const named = new Set(scene.lights.map((light) => light.name));
  let number = 1;
  while (named.has(`${kind} ${number}`)) number++;
  const digits = (v: Vector3) => v.toArray().map((x) => Number(x.toPrecision(5)));
  const light: Named = {
    name: `${kind} ${number}`,
    kind: kind === 'spot' ? 'point' : kind,
    direction: digits(offset.clone().negate().normalize()),
    // A grey surface at the model's middle gets about the radiance of white.
    intensity: Number((kind === 'directional' ? 3 : 3 * distance * distance).toPrecision(3)),
  };
  if (kind !== 'directional') light.position = digits(offset.add(middle));
  if (kind === 'spot') Object.assign(light, { inner_angle: 12, outer_angle: 22 });
  const size = Number((radius * 0.8).toPrecision(3));
  if (kind === 'rectangle') Object.assign(light, { width: size, height: size, points: 9, visible: false });
  if (kind === 'disk' || kind === 'sphere') Object.assign(light, { radius: size / 2, points: 9, visible: false });
  return light;
}
