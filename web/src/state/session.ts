// The one connection of the page, and what its messages do to the store.
import { Connection, ConnectionLost, Refused } from '../protocol/socket';
import type { ChangedObject, Incoming, Outgoing, Scene, SceneObject } from '../protocol/messages';
import { complain, mention } from './notices';
import { shared } from './share';
import { get, set } from './store';

type FrameSink = (data: ArrayBuffer) => void;
let frameSink: FrameSink | null = null;
let waitingFrames: ArrayBuffer[] = [];

// Who draws the frames, one at most. Frames that come before there is one wait for it: they are two at most, since none was shown.
export function drawFramesWith(sink: FrameSink | null): void {
  frameSink = sink;
  if (!sink) return;
  waitingFrames.forEach(sink);
  waitingFrames = [];
}

export const connection = new Connection({
  state(state) {
    set({ connection: state });
    if (state !== 'open') return;
    waitingFrames = [];
    // The picture fills the window. Told before a model is opened, so that the model is framed for it.
    connection.send({ view: { width: Math.round(window.innerWidth * devicePixelRatio), height: Math.round(window.innerHeight * devicePixelRatio) } });
    connection.send({ files: null });
  },
  message: receive,
  frame(data) {
    if (frameSink) frameSink(data);
    else waitingFrames.push(data);
  },
});

export const send = (message: Outgoing) => connection.send(message);

// The answer, or undefined where it was refused: then the user has been told.
export async function ask(message: Outgoing): Promise<Incoming | undefined> {
  try {
    return await connection.request(message);
  } catch (error) {
    if (error instanceof Refused) complain(error.failure);
    else if (!(error instanceof ConnectionLost)) throw error;
    return undefined;
  }
}

function receive(message: Incoming): void {
  if (message.welcome) set({ welcome: message.welcome, closedReason: null });
  if (message.files) set({ files: message.files });
  if (message.opening) set({ opening: message.opening.file, openFailure: null });
  if (message.scene) receiveScene(message.scene);
  if (message.edited) {
    const { can_undo, can_redo } = message.edited;
    const { scene } = get();
    if (scene) set({ scene: shared(scene, { ...scene, can_undo, can_redo }) });
  }
  if (message.progress) set({ progress: message.progress });
  if (message.error && message.id === undefined) {
    const file = get().opening;
    if (file) set({ opening: null, openFailure: { file, failure: message.error } });
    else complain(message.error);
  }
  if (message.closed) set({ closedReason: message.closed.reason });
}

function receiveScene({ opened, warnings, changed, gone, ...members }: NonNullable<Incoming['scene']>): void {
  const { scene: old, opening } = get();
  for (const warning of warnings ?? []) mention(warning);
  if (old && !opened) {
    const news = shared(pick(old, members), members);
    set({ scene: { ...old, ...news, objects: changedObjects(old.objects, changed ?? [], gone ?? []) } as Scene });
    return;
  }
  const again = old !== null && opening === null && old.file === members.file;
  set({ scene: members as Scene, opening: null, openFailure: null });
  if (!again) set({ selection: [], hovered: null, light: null, isolated: null, replayed: null, pixel: null, point: null, lastEdit: null, layer: 'color', expanded: new Set((members.roots ?? []).map(String)) });
  document.title = `${titleOf(members as Scene)} – Crescente`;
}

// Those members of the scene that the message has, too.
const pick = (scene: Scene, members: object) => Object.fromEntries(Object.entries(scene).filter(([name]) => name in members));

// Objects that are as they were keep their identity, and so does the list if all are.
function changedObjects(objects: SceneObject[], changed: ChangedObject[], gone: number[]): SceneObject[] {
  if (changed.length === 0 && gone.length === 0) return objects;
  const news = new Map(changed.map((object) => [object.index, object]));
  const left = new Set(gone);
  const kept = objects.filter(({ index }) => !left.has(index)).map((object) => {
    const differs = news.get(object.index);
    news.delete(object.index);
    return differs ? { ...object, ...differs } : object;
  });
  // What is left is new, with all its members.
  return [...kept, ...(news.values() as Iterable<SceneObject>)].sort((a, b) => a.index - b.index);
}

// What the scene is called: by itself, or as its file.
export const titleOf = (scene: Scene) => scene.name || scene.file.slice(scene.file.lastIndexOf('/') + 1);
