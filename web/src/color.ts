// Colours: linear light in the scene (Rec. 709 primaries), sRGB on the screen.
import type { Vector } from './protocol/messages';

const encode = (x: number) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
const decode = (x: number) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
const byte = (x: number) => Math.round(Math.min(Math.max(encode(x), 0), 1) * 255);

// A colour of a scene file: three numbers, one for grey, or #rrggbb.
export function linearOf(value: unknown): Vector {
  if (typeof value === 'number') return [value, value, value];
  if (Array.isArray(value) && value.length >= 3) return [Number(value[0]), Number(value[1]), Number(value[2])];
  if (typeof value === 'string' && /^#[0-9a-f]{6}$/i.test(value)) return [1, 3, 5].map((i) => decode(parseInt(value.slice(i, i + 2), 16) / 255)) as Vector;
  return [0, 0, 0];
}

export const hexOf = (color: Vector) => `#${color.map((x) => byte(x).toString(16).padStart(2, '0')).join('')}`;

// What a ball of the material looks like from afar.
export function swatchOf(material: Record<string, unknown>): { color: string; metal: boolean } {
  const k = linearOf(material.k ?? [0, 0, 0]);
  if (k.some((x) => x > 0)) {
    const eta = linearOf(material.eta ?? [0, 0, 0]);
    // Fresnel's reflectance of a metal, straight on.
    return { color: hexOf(eta.map((n, i) => ((n - 1) ** 2 + k[i] ** 2) / ((n + 1) ** 2 + k[i] ** 2)) as Vector), metal: true };
  }
  if (material.model === 'classic') return { color: hexOf(linearOf(material.diffuse ?? 0.8)), metal: false };
  const glass = typeof material.transmission === 'number' && material.transmission > 0.5;
  const attenuation = linearOf(material.attenuation ?? 0);
  const base = linearOf(material.base_color ?? 0.8);
  const color = glass ? (base.map((x, i) => x * 0.85 * Math.exp(-attenuation[i] / 60)) as Vector) : base;
  return { color: hexOf(color), metal: typeof material.metallic === 'number' && material.metallic > 0.5 };
}
