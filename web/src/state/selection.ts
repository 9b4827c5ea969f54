// What is selected, hovered, isolated.
import { setVisible, edit } from './edits';
import { isGround } from './ground';
import { indicesOf, leafOf, objectAt, parentOf } from './tree';
import { get, set } from './store';

export function select(path: string | null, add = false): void {
  const { selection } = get();
  let next: string[];
  if (path === null) next = add ? selection : [];
  else if (add) next = selection.includes(path) ? selection.filter((one) => one !== path) : [...selection, path];
  else next = [path];
  set({ selection: next, light: null });
  if (path) reveal(path);
}

// Opens what is above the path in the tree.
export function reveal(path: string): void {
  const expanded = new Set(get().expanded);
  for (let above = parentOf(path); above !== null; above = parentOf(above)) expanded.add(above);
  set({ expanded });
}

export function toggleExpanded(path: string): void {
  const expanded = new Set(get().expanded);
  if (!expanded.delete(path)) expanded.add(path);
  set({ expanded });
}

export function hover(path: string | null): void {
  if (get().hovered !== path) set({ hovered: path });
}

export function toggleVisible(index: number): void {
  const { scene } = get();
  const object = scene && objectAt(scene, index);
  if (object) void setVisible([index], !object.visible);
}

export function hideSelection(): void {
  const { selection } = get();
  if (selection.length > 0) void setVisible(selection.map(leafOf), false);
}

// Hides what is beside the selection and beside what is above it; a second time brings back what was seen before.
export async function toggleIsolated(): Promise<void> {
  const { scene, selection, isolated } = get();
  if (!scene) return;
  if (isolated) {
    const back = [...isolated].filter(([index]) => objectAt(scene, index)).map(([index]) => index);
    if (await edit({ show: back }, 'Show all again')) set({ isolated: null });
    return;
  }
  if (selection.length === 0) return;
  const kept = new Set(selection.flatMap(indicesOf));
  const leaves = new Set(selection.map(leafOf));
  const hidden: number[] = [];
  const visit = (index: number) => {
    const object = objectAt(scene, index);
    if (!object || leaves.has(index)) return;
    if (!kept.has(index)) {
      if (object.visible && !isGround(object.name)) hidden.push(index);
    } else object.children.forEach(visit);
  };
  scene.roots.forEach(visit);
  if (hidden.length > 0 && (await edit({ hide: hidden }, 'Isolate'))) set({ isolated: new Map(hidden.map((index) => [index, true])) });
}
