// Opening another model over the one that is there.
import { Modal, Text } from '@mantine/core';
import { set, useStore } from '../state/store';
import { FileChoices } from './file_choices';

export function OpenDialog() {
  const open = useStore((s) => s.scene !== null && (s.dialog === 'open' || s.openFailure !== null));
  return (
    <Modal opened={open} onClose={() => set({ dialog: null, openFailure: null })} title={<Text fw={600}>Open a model</Text>} size="xl">
      <FileChoices />
    </Modal>
  );
}
