// A field that is being dragged shows where the pointer has it; every step is an edit, and all of them together are one undo.
import { useCallback, useEffect, useRef } from 'react';
import { Drag, edit } from '../../state/edits';
import type { Outgoing } from '../../protocol/messages';

export type Change = (field: string, value: unknown, ongoing: boolean) => void;

export function useDrag(toEdit: (field: string, value: unknown) => Outgoing, titleOf: (field: string) => string): Change {
  const drag = useRef<Drag | null>(null);
  const now = useRef({ toEdit, titleOf });
  useEffect(() => {
    now.current = { toEdit, titleOf };
  });
  // The same function for good, so that controls whose value rests are not drawn anew.
  return useCallback((field, value, ongoing) => {
    const { toEdit, titleOf } = now.current;
    if (!ongoing && !drag.current) {
      void edit(toEdit(field, value), titleOf(field));
      return;
    }
    drag.current ??= new Drag(titleOf(field));
    void drag.current.send(toEdit(field, value));
    if (!ongoing) drag.current = null;
  }, []);
}
