// The assembly: a path is what leads from a root to an object, indices joined by '/'. An object that is shown in several places has several paths.
import { Box3, Matrix4, Vector3 } from 'three';
import type { Bounds, Scene, SceneObject } from '../protocol/messages';

export const pathOf = (indices: number[]) => indices.join('/');
export const indicesOf = (path: string) => path.split('/').map(Number);
export const leafOf = (path: string) => Number(path.slice(path.lastIndexOf('/') + 1));
export const parentOf = (path: string) => (path.includes('/') ? path.slice(0, path.lastIndexOf('/')) : null);
export const inside = (path: string, above: string) => path === above || path.startsWith(`${above}/`);

const byIndex = new WeakMap<SceneObject[], Map<number, SceneObject>>();

// What the assembly is made of.
export type Assembly = Pick<Scene, 'objects' | 'roots'>;

export function objectAt(scene: Pick<Scene, 'objects'>, index: number): SceneObject | undefined {
  let map = byIndex.get(scene.objects);
  if (!map) {
    map = new Map(scene.objects.map((object) => [object.index, object]));
    byIndex.set(scene.objects, map);
  }
  return map.get(index);
}

export const nameOf = (object: SceneObject | undefined) => object?.name || `${object?.shape ?? 'group'} ${object?.index ?? ''}`;

export type Row = { path: string; object: SceneObject; depth: number; hidden: boolean; open: boolean };

// The rows that the tree shows: below what is expanded, or, with a search, what has the words in its name and what leads there.
export function rowsOf(scene: Assembly, expanded: ReadonlySet<string>, search: string): Row[] {
  const words = search.trim().toLowerCase();
  const rows: Row[] = [];
  const found = new Map<number, boolean>();
  const matches = (index: number): boolean => {
    const known = found.get(index);
    if (known !== undefined) return known;
    const object = objectAt(scene, index);
    const answer = !!object && (nameOf(object).toLowerCase().includes(words) || object.children.some(matches));
    found.set(index, answer);
    return answer;
  };
  const visit = (index: number, above: string | null, depth: number, hiddenAbove: boolean) => {
    const object = objectAt(scene, index);
    if (!object || (words && !matches(index))) return;
    const path = above === null ? String(index) : `${above}/${index}`;
    const open = object.children.length > 0 && (expanded.has(path) || (words !== '' && object.children.some(matches)));
    const hidden = hiddenAbove || !object.visible;
    rows.push({ path, object, depth, hidden, open });
    if (open) for (const child of object.children) visit(child, path, depth + 1, hidden);
  };
  for (const root of scene.roots) visit(root, null, 0, false);
  return rows;
}

export function matrixOf(rows: number[]): Matrix4 {
  const [a, b, c, d, e, f, g, h, i, j, k, l] = rows;
  return new Matrix4().set(a, b, c, d, e, f, g, h, i, j, k, l, 0, 0, 0, 1);
}

// 12 numbers by rows, as in scene files.
export function rowsOfMatrix(matrix: Matrix4): number[] {
  const m = matrix.elements;
  return [m[0], m[4], m[8], m[12], m[1], m[5], m[9], m[13], m[2], m[6], m[10], m[14]];
}

// From the object's space to the scene's.
export function worldOf(scene: Pick<Scene, 'objects'>, path: string): Matrix4 {
  const world = new Matrix4();
  for (const index of indicesOf(path)) {
    const object = objectAt(scene, index);
    if (object) world.multiply(matrixOf(object.transform));
  }
  return world;
}

export const boxOf = (bounds: Bounds) => new Box3(new Vector3(...bounds.low), new Vector3(...bounds.high));

// The box in the scene's axes around what the path leads to; null if nothing is there.
export function worldBox(scene: Pick<Scene, 'objects'>, path: string): Box3 | null {
  const bounds = objectAt(scene, leafOf(path))?.bounds;
  return bounds ? boxOf(bounds).applyMatrix4(worldOf(scene, path)) : null;
}

// The material that the object shows: its own, or the nearest above.
export function materialOf(scene: Pick<Scene, 'objects'>, path: string): number | null {
  for (const index of indicesOf(path).reverse()) {
    const material = objectAt(scene, index)?.material;
    if (material !== null && material !== undefined) return material;
  }
  return null;
}
