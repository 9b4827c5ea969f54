// Files: opening, uploading, what is at hand.
import { address, Refused } from '../protocol/socket';
import type { Failure } from '../protocol/messages';
import { ask, connection } from './session';
import { warn } from './notices';
import { get, set } from './store';

export async function openFile(file: string): Promise<void> {
  set({ opening: file, openFailure: null, dialog: null });
  try {
    await connection.request({ open: file });
  } catch (error) {
    const failure: Failure = error instanceof Refused ? error.failure : { kind: 'input', problems: [{ file: '', place: '', hint: '', reason: error instanceof Error ? error.message : String(error) }] };
    set({ opening: null, openFailure: { file, failure } });
  }
}

export const listFolder = (folder: string | null) => ask({ files: folder });

// The name under which the program has the file; null if it did not take it.
export async function upload(file: File): Promise<string | null> {
  const limit = get().welcome?.limits.upload;
  if (limit !== undefined && file.size > limit) {
    warn(`${file.name} is too large`, `The program takes files up to ${Math.floor(limit / 1e6)} MB`);
    return null;
  }
  try {
    const response = await fetch(address('upload', { name: file.name, session: get().welcome?.session ?? '' }), { method: 'POST', body: file });
    const answer = (await response.json()) as { file?: string; error?: { problems?: { reason: string }[] } };
    if (answer.file !== undefined) return answer.file;
    warn(`${file.name} was not taken`, answer.error?.problems?.[0]?.reason ?? response.statusText);
  } catch (error) {
    warn(`${file.name} could not be sent`, error instanceof Error ? error.message : String(error));
  }
  return null;
}

const isEnvironment = (name: string) => /\.(hdr|exr)$/i.test(name);

// Models are opened, pictures of surroundings put around the model that is there. Of several files the first model is opened, after all are sent: a .gltf finds its .bin beside it.
export async function receiveFiles(files: File[]): Promise<void> {
  const models: string[] = [];
  for (const file of files) {
    if (isEnvironment(file.name) && get().scene) await uploadEnvironment(file);
    else {
      const name = await upload(file);
      if (name !== null && !/\.(bin|png|jpe?g|mtl)$/i.test(name)) models.push(name);
    }
  }
  if (models.length > 0) await openFile(models[0]);
}

export async function uploadEnvironment(file: File): Promise<void> {
  const name = await upload(file);
  if (name !== null) await chooseEnvironment(name);
}

export async function chooseEnvironment(file: string | null): Promise<void> {
  if (await ask({ environment_file: file })) set({ lastEdit: 'Environment' });
}
