// What the page knows: what the program has told, and what the user has chosen here. One store; who changes what is in the other files of this folder.
import { create } from 'zustand';
import type { ConnectionState } from '../protocol/socket';
import type { Failure, Files, Progress, Replayed, Scene, Vector, Welcome } from '../protocol/messages';

export type Tool = 'select' | 'move' | 'rotate';
export type RightTab = 'material' | 'object' | 'lights' | 'studio' | 'cameras' | 'numbers';

export type ExportItem = { key: number; title: string; fraction: number; number?: number; address?: string; name?: string; bytes?: number; problem?: string };

export type Store = {
  connection: ConnectionState;
  closedReason: string | null;
  welcome: Welcome | null;
  files: Files | null;
  opening: string | null; // the file that is being read
  openFailure: { file: string; failure: Failure } | null;
  scene: Scene | null;
  progress: Progress | null;
  lastEdit: string | null;
  exports: ExportItem[];

  selection: string[]; // paths, the last is the one that panels show
  hovered: string | null;
  expanded: ReadonlySet<string>;
  light: number | null; // index of the light that is being edited
  isolated: ReadonlyMap<number, boolean> | null; // what was visible before everything else was hidden
  tool: Tool;
  snap: boolean;
  leftOpen: boolean;
  rightOpen: boolean;
  rightTab: RightTab;
  dialog: 'help' | 'export' | 'open' | null;
  turntable: boolean;
  orthographic: boolean;
  layer: string;
  pixel: { x: number; y: number } | null;
  point: Vector | null; // where the surface was met that was clicked last
  replayed: Replayed | null;
  replaying: boolean;
};

const roomy = typeof window === 'undefined' || window.innerWidth >= 1100;

export const useStore = create<Store>()(() => ({
  connection: 'connecting',
  closedReason: null,
  welcome: null,
  files: null,
  opening: null,
  openFailure: null,
  scene: null,
  progress: null,
  lastEdit: null,
  exports: [],
  selection: [],
  hovered: null,
  expanded: new Set<string>(),
  light: null,
  isolated: null,
  tool: 'select',
  snap: false,
  leftOpen: roomy,
  rightOpen: roomy,
  rightTab: 'material',
  dialog: null,
  turntable: false,
  orthographic: false,
  layer: 'color',
  pixel: null,
  point: null,
  replayed: null,
  replaying: false,
}));

export const get = useStore.getState;
export const set = useStore.setState;
