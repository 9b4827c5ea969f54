// Files dropped anywhere on the page are opened.
import { Dropzone } from '@mantine/dropzone';
import { Group, Text } from '@mantine/core';
import { IconFileImport } from '@tabler/icons-react';
import { receiveFiles } from '../state/files';

export function DropAnywhere() {
  return (
    <Dropzone.FullScreen onDrop={(files) => void receiveFiles(files)} aria-label="Drop a model to open it" inputProps={{ 'aria-label': 'Model to open' }}>
      <Group justify="center" mih="80vh" gap="md" style={{ pointerEvents: 'none' }}>
        <IconFileImport size={48} stroke={1.3} />
        <div>
          <Text size="xl" fw={600}>Drop to open</Text>
          <Text c="dimmed">A model, or .hdr and .exr surroundings for the one that is open</Text>
        </div>
      </Group>
    </Dropzone.FullScreen>
  );
}
