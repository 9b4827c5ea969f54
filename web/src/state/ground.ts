// The ground that a studio puts under the model: seen, seen only by its shadows, or not there.
import type { Scene } from '../protocol/messages';
import { callName, edit } from './edits';
import { get } from './store';

export type Ground = 'solid' | 'catch' | 'none';

// What the program calls the object and its material.
const studioGround = 'studio ground';
export const isGround = (name: string) => name === studioGround;

const objectOf = (scene: Scene) => scene.objects.find((object) => isGround(object.name));

// Null where the scene has no such ground.
export function groundOf(scene: Scene): Ground | null {
  const object = objectOf(scene);
  if (!object) return null;
  if (!object.visible) return 'none';
  return object.material !== null && scene.materials[object.material]?.catcher === true ? 'catch' : 'solid';
}

export async function setGround(ground: Ground): Promise<void> {
  const { scene } = get();
  const object = scene && objectOf(scene);
  if (!object) return;
  const { index, material } = object;
  if (ground === 'none') await edit({ hide: index }, 'Ground: none');
  else if (material !== null) {
    const catcher = { set: { [`material.${callName(scene.materials[material], material)}.catcher`]: ground === 'catch' } };
    await edit({ batch: [{ show: index }, catcher] }, `Ground: ${ground === 'catch' ? 'shadow only' : 'solid'}`);
  }
}
