// The keys and what they do; the help dialog lists this table.
import { duplicateSelection, redo, removeSelection, undo } from '../state/edits';
import { hideSelection, select, toggleIsolated } from '../state/selection';
import { send } from '../state/session';
import { get, set } from '../state/store';
import { theStage } from './current_stage';

export type Shortcut = { keys: string; shown: string; group: string; title: string; run: () => void };

const navigation = () => theStage()?.navigation;
const nudge = 10; // degrees

export const setPaused = (pause: boolean) => {
  send({ pause });
  const { progress } = get();
  if (progress) set({ progress: { ...progress, paused: pause } });
};

export const shortcuts: Shortcut[] = [
  { keys: 'F', shown: 'F', group: 'View', title: 'Fit the selection', run: () => theStage()?.fit() },
  { keys: 'shift+F', shown: 'Shift F', group: 'View', title: 'Fit everything', run: () => theStage()?.fit(true) },
  { keys: '1', shown: '1', group: 'View', title: 'Front', run: () => theStage()?.look('front') },
  { keys: '2', shown: '2', group: 'View', title: 'Back', run: () => theStage()?.look('back') },
  { keys: '3', shown: '3', group: 'View', title: 'Right', run: () => theStage()?.look('right') },
  { keys: '4', shown: '4', group: 'View', title: 'Left', run: () => theStage()?.look('left') },
  { keys: '5', shown: '5', group: 'View', title: 'Top', run: () => theStage()?.look('top') },
  { keys: '6', shown: '6', group: 'View', title: 'Bottom', run: () => theStage()?.look('bottom') },
  { keys: '0', shown: '0', group: 'View', title: 'From the corner', run: () => theStage()?.look('isometric') },
  { keys: 'P', shown: 'P', group: 'View', title: 'Perspective or orthographic', run: () => set({ orthographic: !get().orthographic }) },
  { keys: 'T', shown: 'T', group: 'View', title: 'Turntable', run: () => set({ turntable: !get().turntable }) },
  { keys: 'ArrowLeft', shown: '←', group: 'View', title: 'Turn left', run: () => navigation()?.turn(-nudge, 0) },
  { keys: 'ArrowRight', shown: '→', group: 'View', title: 'Turn right', run: () => navigation()?.turn(nudge, 0) },
  { keys: 'ArrowUp', shown: '↑', group: 'View', title: 'Turn up', run: () => navigation()?.turn(0, -nudge) },
  { keys: 'ArrowDown', shown: '↓', group: 'View', title: 'Turn down', run: () => navigation()?.turn(0, nudge) },
  { keys: 'shift+ArrowLeft', shown: 'Shift ←', group: 'View', title: 'Pan left', run: () => navigation()?.truck(-0.2, 0) },
  { keys: 'shift+ArrowRight', shown: 'Shift →', group: 'View', title: 'Pan right', run: () => navigation()?.truck(0.2, 0) },
  { keys: 'shift+ArrowUp', shown: 'Shift ↑', group: 'View', title: 'Pan up', run: () => navigation()?.truck(0, -0.2) },
  { keys: 'shift+ArrowDown', shown: 'Shift ↓', group: 'View', title: 'Pan down', run: () => navigation()?.truck(0, 0.2) },
  { keys: '[Equal]', shown: '+', group: 'View', title: 'Zoom in', run: () => navigation()?.zoomBy(1.25) },
  { keys: '[Minus]', shown: '−', group: 'View', title: 'Zoom out', run: () => navigation()?.zoomBy(0.8) },
  { keys: 'mod+Z', shown: 'Ctrl Z', group: 'Edit', title: 'Undo', run: () => void (get().scene?.can_undo && undo()) },
  { keys: 'mod+shift+Z', shown: 'Ctrl Shift Z', group: 'Edit', title: 'Redo', run: () => void (get().scene?.can_redo && redo()) },
  { keys: 'mod+Y', shown: 'Ctrl Y', group: 'Edit', title: 'Redo', run: () => void (get().scene?.can_redo && redo()) },
  { keys: 'S', shown: 'S', group: 'Edit', title: 'Select', run: () => set({ tool: 'select' }) },
  { keys: 'M', shown: 'M', group: 'Edit', title: 'Move', run: () => set({ tool: 'move' }) },
  { keys: 'R', shown: 'R', group: 'Edit', title: 'Rotate', run: () => set({ tool: 'rotate' }) },
  { keys: 'N', shown: 'N', group: 'Edit', title: 'Snap to steps', run: () => set({ snap: !get().snap }) },
  { keys: 'mod+D', shown: 'Ctrl D', group: 'Edit', title: 'Duplicate', run: () => void duplicateSelection() },
  { keys: 'Delete', shown: 'Del', group: 'Edit', title: 'Delete', run: () => void removeSelection() },
  { keys: 'H', shown: 'H', group: 'Edit', title: 'Hide the selection', run: hideSelection },
  { keys: 'I', shown: 'I', group: 'Edit', title: 'Isolate the selection, and back', run: () => void toggleIsolated() },
  { keys: 'Escape', shown: 'Esc', group: 'Edit', title: 'Select nothing', run: () => (select(null), set({ light: null, tool: 'select', turntable: false })) },
  { keys: 'space', shown: 'Space', group: 'Picture', title: 'Pause or go on', run: () => setPaused(!get().progress?.paused) },
  { keys: 'mod+E', shown: 'Ctrl E', group: 'Picture', title: 'Export', run: () => set({ dialog: 'export' }) },
  { keys: 'mod+O', shown: 'Ctrl O', group: 'Picture', title: 'Open', run: () => set({ dialog: 'open' }) },
  { keys: 'shift+?', shown: '?', group: 'Picture', title: 'This help', run: () => set({ dialog: 'help' }) },
];
