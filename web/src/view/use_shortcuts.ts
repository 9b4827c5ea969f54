import { useHotkeys } from '@mantine/hooks';
import { get } from '../state/store';
import { shortcuts } from './shortcuts';

const inDialogs = new Set(['mod+Z', 'mod+shift+Z', 'mod+Y']);

// Where letters are typed.
const typing = (element: EventTarget | null) => element instanceof HTMLElement && element.matches('textarea, select, input:not([type=radio], [type=checkbox], [type=range])');

// Keys act on the page unless one is typing, or a button, a list or a dialog wants the key for itself.
export function useShortcuts(): void {
  useHotkeys(
    shortcuts.map(({ keys, run }) => [
      keys,
      (event: KeyboardEvent) => {
        const plain = !keys.includes('mod');
        const taken = plain && /^(Arrow|Space|space|Enter)/.test(keys.replace('shift+', '')) && event.target instanceof HTMLElement && event.target.closest('button, [role=tree], [role=slider], [role=tab], [role=menu], [role=radiogroup], a');
        if (taken || typing(event.target) || (get().dialog !== null && !inDialogs.has(keys)) || !get().scene) return;
        event.preventDefault();
        run();
      },
      { preventDefault: false },
    ]),
    [],
  );
}
