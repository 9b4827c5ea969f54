// The messages of docs/protocol.md. What the program says is generated from its schema; here are the names that the page uses, and what it knows more closely: parts of the scene that
// have the form of scene files (docs/scene_format.md) are records, whose fields the page reads from their tables (fields.ts).
import type * as replies from './generated/replies';

export type { Bounds, ChangedObject, Exported, Failure, FileEntry, Files, Incoming, LibraryMaterial, Picked, Progress, Replayed, SceneObject, Tree, Welcome } from './generated/replies';

export type Vector = [number, number, number];
export type Values = Record<string, unknown>;
export type Named = Values & { name?: string };

export type Camera = {
  projection?: 'perspective' | 'orthographic';
  position?: Vector;
  target?: Vector;
  up?: Vector;
  field_of_view?: number;
  height?: number;
};

// The whole scene: what was told when it was opened, with all that edits have changed since.
export type Scene = Omit<replies.Scene, 'opened' | 'warnings' | 'changed' | 'gone' | 'bounds' | 'objects' | 'roots' | 'materials' | 'lights' | 'camera' | 'environment' | 'settings'> & {
  bounds: replies.Bounds | null;
  objects: replies.SceneObject[];
  roots: number[];
  materials: Named[];
  lights: Named[];
  camera: Camera;
  environment: Values | null;
  settings: Values;
};

export type ExportRequest = { format: string; width: number; height: number; level: string };

// A verb with its value, and beside it perhaps a gesture: consecutive edits with the same one are taken back as one.
export type Outgoing = Record<string, unknown>;
