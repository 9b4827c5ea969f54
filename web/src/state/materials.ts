// Giving parts materials of the scene or of the library.
import type { Named, Outgoing } from '../protocol/messages';
import { edit } from './edits';
import { tell } from './notices';
import { leafOf } from './tree';
import { get } from './store';

type Choice = { name: string | number; make: Outgoing | null; title: string };

const ofScene = (material: Named, index: number): Choice => ({ name: material.name || index, make: null, title: material.name || `Material ${index}` });

// The first use of one of the library puts it among the scene's materials, by its name.
function ofLibrary(name: string): Choice {
  const there = get().scene?.materials.some((material) => material.name === name);
  return { name, make: there ? null : { material: { name, library: name } }, title: name };
}

export function assignTo(objects: number[], { name, make, title }: Choice): Promise<boolean> {
  const assign = { assign: { object: objects, material: name, below: true } };
  return edit(make ? { batch: [make, assign] } : assign, `Material: ${title}`);
}

function apply(choice: Choice): Promise<boolean> {
  const objects = get().selection.map(leafOf);
  if (objects.length > 0) return assignTo(objects, choice);
  tell('Select a part first, or drag the material onto one');
  return Promise.resolve(false);
}

export const applyMaterial = (material: Named, index: number) => apply(ofScene(material, index));
export const applyLibrary = (name: string) => apply(ofLibrary(name));

// What a dragged swatch carries.
export const dragOfMaterial = (material: Named, index: number) => JSON.stringify(ofScene(material, index));
export const dragOfLibrary = (name: string) => JSON.stringify({ library: name });

export function assignDropped(objects: number[], text: string): Promise<boolean> {
  const dropped = JSON.parse(text) as Choice & { library?: string };
  return assignTo(objects, dropped.library !== undefined ? ofLibrary(dropped.library) : dropped);
}
