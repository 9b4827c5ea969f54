// What a control shows while it is being dragged: where the pointer has it, not what the program answers meanwhile, which lags behind.
import { useEffect, useRef, useState } from 'react';

export function useDraft<T>(value: T): { shown: T; drag(to: T): void; end(): void } {
  const [draft, setDraft] = useState<{ value: T } | null>(null);
  const dragging = useRef(false);
  useEffect(() => {
    if (!dragging.current) setDraft(null);
  }, [value]);
  return {
    shown: draft ? draft.value : value,
    drag(to) {
      dragging.current = true;
      setDraft({ value: to });
    },
    end() {
      dragging.current = false;
    },
  };
}
