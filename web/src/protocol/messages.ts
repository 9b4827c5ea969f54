// The messages of docs/protocol.md, version 1. Values of the scene (materials, lights, camera, environment, settings) are those of scene files (docs/scene_format.md):
// their fields are read from the scene's schema (fields.ts), so here they are plain records.

export type Vector = [number, number, number];
export type Bounds = { low: Vector; high: Vector };
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

export type SceneObject = {
  index: number;
  name: string;
  visible: boolean;
  shape: string | null;
  triangles?: number;
  faces?: number;
  material: number | null;
  transform: number[];
  bounds: Bounds | null;
  children: number[];
};

export type Scene = {
  name: string;
  unit: string;
  revision: number;
  bounds: Bounds | null;
  model: Bounds | null; // without the studio's ground: what is framed
  file: string;
  roots: number[];
  objects: SceneObject[];
  materials: Named[];
  lights: Named[];
  camera: Camera;
  environment: Values | null;
  settings: Values;
  can_undo: boolean;
  can_redo: boolean;
};

export type LibraryMaterial = { name: string; group: string; note?: string; color: Vector };

export type Welcome = {
  version: string;
  protocol: number;
  session: string;
  taken_up?: boolean;
  limits: { upload: number; width: number; height: number };
  levels: string[];
  formats: string[];
  layers?: string[];
  studios?: string[];
  library?: LibraryMaterial[];
};

// file: what `open` takes.
export type FileEntry = { name: string; file?: string; title?: string; bytes?: number; time?: number };
export type Files = { folder: string | null; folders: string[]; files: FileEntry[]; examples?: FileEntry[]; recent?: FileEntry[]; environments?: FileEntry[] };

export type Picked = { path: number[]; face: number; material: number | null; position: Vector; normal: Vector; look?: number };

export type Edited = { tiles: number; began_anew: boolean; seconds: number; can_undo: boolean; can_redo: boolean };

export type Progress = {
  level: string;
  until?: string;
  fraction: number;
  done: boolean;
  paused: boolean;
  first_picture: boolean;
  seconds: number;
  rays: number;
  rays_per_second: number;
  bytes: number;
  nodes: number;
  edit_rays: number;
  edit_camera_rays?: number;
  fresh_rays: number | null;
};

export type Exporting = { number: number; fraction: number };
export type Exported = { number: number; name: string; bytes: number; address: string };
export type ExportRequest = { format: string; width: number; height: number; level: string };

export type Tree = { children?: Tree[] } & Values;
export type Replayed = { text: string; trees?: Tree[] };

export type Problem = { file?: string; place?: string; reason: string; hint?: string };
export type Failure = { kind: string; problems: Problem[] };

// What a text message of the program may have.
export type Incoming = {
  id?: number;
  welcome?: Welcome;
  files?: Files;
  opening?: { file: string; fraction?: number; stage?: string };
  opened?: { file: string };
  scene?: Partial<Scene>;
  edited?: Edited;
  picked?: Picked | null;
  replayed?: Replayed;
  progress?: Progress;
  exporting?: Exporting;
  exported?: Exported;
  error?: Failure;
  closed?: { reason: string };
};

// A verb with its value, and beside it perhaps a gesture: consecutive edits with the same one are taken back as one.
export type Outgoing = Record<string, unknown>;
