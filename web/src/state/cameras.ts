// Views that the user has kept, for each model, in this browser.
import type { WholeCamera } from '../view/camera';

export type KeptCamera = { name: string; camera: WholeCamera };

const keyOf = (model: string) => `crescente.cameras.${model}`;

export function keptCameras(model: string): KeptCamera[] {
  try {
    const list: unknown = JSON.parse(localStorage.getItem(keyOf(model)) ?? '[]');
    return Array.isArray(list) ? (list as KeptCamera[]).filter((one) => typeof one?.name === 'string' && Array.isArray(one.camera?.position)) : [];
  } catch {
    return [];
  }
}

export const keepCameras = (model: string, cameras: KeptCamera[]) => localStorage.setItem(keyOf(model), JSON.stringify(cameras));
