// Edits of the scene, as docs/edits.md has them. Each is told the program; what it answers is what the page shows.
import type { Named, Outgoing } from '../protocol/messages';
import { ask } from './session';
import { leafOf } from './tree';
import { get, set, useStore, type Store } from './store';

let gestures = 0;

// Edits with one gesture are taken back as one.
export const newGesture = () => `gesture ${Date.now().toString(36)}.${gestures++}`;

export async function edit(verb: Outgoing, title: string, gesture?: string): Promise<boolean> {
  const answer = await ask(gesture ? { ...verb, gesture } : verb);
  if (answer) set({ lastEdit: title });
  return answer !== undefined;
}

// A drag: of the edits that come while one is on its way only the newest is sent.
export class Drag {
  private readonly gesture = newGesture();
  private next: Outgoing | null = null;
  private last = '';
  private busy = false;

  constructor(private readonly title: string) {}

  async send(verb: Outgoing): Promise<void> {
    const text = JSON.stringify(verb);
    if (text === this.last) return; // the end of a drag says its last step again
    this.last = text;
    this.next = verb;
    if (this.busy) return;
    this.busy = true;
    while (this.next) {
      const now: Outgoing = this.next;
      this.next = null;
      await edit(now, this.title, this.gesture);
    }
    this.busy = false;
  }
}

let turn: Promise<unknown> = Promise.resolve();

// An edit of which a part is as it is now, such as two of three coordinates. It is made once the page knows what those before it did: two boxes that are filled in quickly are two changes. make: null where there is nothing to
// be edited any more.
export function editInTurn(make: () => Outgoing | null, title: string): Promise<boolean> {
  const done = turn.then(async () => {
    const verb = make();
    const answer = verb && (await ask(verb));
    if (!answer?.edited) return false;
    set({ lastEdit: title });
    await known(answer.edited.revision);
    return true;
  });
  turn = done.catch(() => undefined);
  return done;
}

// Once the page has the scene of that revision, or has lost the connection.
const known = (revision: number) =>
  new Promise<void>((resolve) => {
    const is = ({ scene, connection }: Store) => connection !== 'open' || !scene || scene.revision >= revision;
    if (is(get())) return resolve();
    const stop = useStore.subscribe((state) => {
      if (!is(state)) return;
      stop();
      resolve();
    });
  });

// How materials and lights are called in a path of `set`: by name, one without a name by its index.
export const callName = (thing: Named | undefined, index: number) => thing?.name || String(index);

export const setMaterialField = (index: number, field: string, value: unknown): Outgoing => ({ set: { [`material.${callName(get().scene?.materials[index], index)}.${field}`]: value } });
export const setLightField = (index: number, field: string, value: unknown): Outgoing => ({ set: { [`light.${callName(get().scene?.lights[index], index)}.${field}`]: value } });
export const setEnvironmentField = (field: string, value: unknown): Outgoing => ({ set: { [`environment.${field}`]: value } });
export const setSetting = (field: string, value: unknown): Outgoing => ({ set: { [`settings.${field}`]: value } });

export const undo = () => edit({ undo: 1 }, 'Undo');
export const redo = () => edit({ redo: 1 }, 'Redo');

export const setVisible = (objects: number[], visible: boolean) => edit({ [visible ? 'show' : 'hide']: objects }, visible ? 'Show' : 'Hide');

export async function removeSelection(): Promise<void> {
  const { selection, light, scene } = get();
  if (light !== null && scene) {
    if (await edit({ remove_light: callName(scene.lights[light], light) }, 'Delete light')) set({ light: null });
  } else if (selection.length > 0) {
    if (await edit({ remove: selection.map(leafOf) }, selection.length > 1 ? `Delete ${selection.length} parts` : 'Delete part')) set({ selection: [] });
  }
}

// A copy beside the original, a tenth of the model aside, so that it is seen.
export async function duplicateSelection(): Promise<void> {
  const { selection, scene } = get();
  if (!scene || selection.length === 0) return;
  const { low, high } = scene.bounds ?? { low: [0, 0, 0], high: [1, 1, 1] };
  const size = Math.max(...high.map((x, i) => x - low[i]));
  const copies = selection.map((path) => {
    const index = leafOf(path);
    const name = scene.objects.find((object) => object.index === index)?.name || `object ${index}`;
    return { duplicate: { object: index, name: `${name} copy`, by: { translate: [size / 10, 0, 0] } } };
  });
  await edit(copies.length === 1 ? copies[0] : { batch: copies }, 'Duplicate');
}
