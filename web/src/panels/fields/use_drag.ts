// A field that is being dragged shows where the pointer has it; every step is an edit, and all of them together are one undo.
import { useCallback, useEffect, useRef } from 'react';
import { Drag, edit, editInTurn } from '../../state/edits';
import type { Outgoing, Values } from '../../protocol/messages';

// value: the new one, or what makes it of the one that is there by then.
export type Change = (field: string, value: unknown, ongoing: boolean) => void;
export type Remake = (now: unknown) => unknown;

// valuesNow: of all fields, as the page knows them; null: what was edited is gone.
export function useDrag(toEdit: (field: string, value: unknown) => Outgoing, titleOf: (field: string) => string, valuesNow: () => Values | null | undefined): Change {
  const drag = useRef<Drag | null>(null);
  const now = useRef({ toEdit, titleOf, valuesNow });
  useEffect(() => {
    now.current = { toEdit, titleOf, valuesNow };
  });
  // The same function for good, so that controls whose value rests are not drawn anew.
  return useCallback((field, value, ongoing) => {
    const { toEdit, titleOf, valuesNow } = now.current;
    if (typeof value === 'function') {
      const remake = value as Remake;
      void editInTurn(() => {
        const values = valuesNow();
        return values ? toEdit(field, remake(values[field])) : null;
      }, titleOf(field));
      return;
    }
    if (!ongoing && !drag.current) {
      void edit(toEdit(field, value), titleOf(field));
      return;
    }
    drag.current ??= new Drag(titleOf(field));
    void drag.current.send(toEdit(field, value));
    if (!ongoing) drag.current = null;
  }, []);
}
