// The one view of the page, for what steers it from outside: keys, buttons, lists.
import type { Stage } from './stage';

let current: Stage | null = null;

export function setStage(stage: Stage | null): void {
  current = stage;
}

export const theStage = () => current;
