// What a slider spans where the field's own range is wider than what one meets, or has no end.
import type { Field } from '../../protocol/fields';

const usual: Record<string, [number, number]> = {
  ior: [1, 3],
  dispersion: [0, 1],
  eta: [0, 10],
  k: [0, 10],
  shininess: [0, 500],
  anisotropy_rotation: [-180, 180],
  rotation: [-180, 180],
  iridescence_thickness: [0, 1200],
  exposure: [-6, 6],
  exponent: [0, 64],
  depth: [0, 24],
  samples: [1, 1024],
};

export function sliderRange(field: Field, value: number): [number, number] {
  const [low, high] = usual[field.name] ?? [field.minimum ?? Math.min(0, value * 2), field.maximum ?? endFor(value, field.default)];
  return [Math.min(low, value), Math.max(high, value)];
}

// A round number some way above the value, so that there is room to both sides.
function endFor(value: number, otherwise: unknown): number {
  const from = Math.abs(value) || (typeof otherwise === 'number' && otherwise) || 1;
  const power = 10 ** Math.floor(Math.log10(from * 2));
  return ([1, 2, 5, 10].map((k) => k * power).find((end) => end >= from * 2) ?? 10 * power) as number;
}
