// Pictures of any size, rendered in the background to the level one wants.
import { ActionIcon, Button, Divider, Group, Modal, NumberInput, Progress, Select, Stack, Text } from '@mantine/core';
import { IconDownload, IconX } from '@tabler/icons-react';
import { useState } from 'react';
import { bytes } from '../format';
import { labelOf } from '../protocol/fields';
import { cancelExport, fetchFile, startExport } from '../state/exports';
import { titleOf } from '../state/session';
import { set, useStore, type ExportItem } from '../state/store';
import { theStage } from '../view/current_stage';

export function ExportDialog() {
  const open = useStore((s) => s.dialog === 'export');
  return (
    <Modal opened={open} onClose={() => set({ dialog: null })} title={<Text fw={600}>Export a picture</Text>} size="md">
      {open && <ExportForm />}
    </Modal>
  );
}

function ExportForm() {
  const welcome = useStore((s) => s.welcome);
  const name = useStore((s) => (s.scene ? titleOf(s.scene) : 'picture'));
  const until = useStore((s) => s.progress?.until ?? String(s.scene?.settings.level ?? 'edges'));
  const exports = useStore((s) => s.exports);
  const [size, setSize] = useState(() => theStage()?.pixels ?? { width: 1920, height: 1080 });
  const [format, setFormat] = useState('png');
  const [level, setLevel] = useState(until);
  const aspect = (theStage()?.pixels.width ?? 16) / (theStage()?.pixels.height ?? 9);
  const sizes: [string, number, number][] = [
    ['As on the screen', theStage()?.pixels.width ?? 1920, theStage()?.pixels.height ?? 1080],
    ['Full HD', 1920, 1080],
    ['4K', 3840, 2160],
    ['Square 2048', 2048, 2048],
    ['Twice the screen', 2 * (theStage()?.pixels.width ?? 1920), 2 * (theStage()?.pixels.height ?? 1080)],
  ];
  const limits = welcome?.limits;
  const formats = (welcome?.formats ?? ['png']).filter((one) => one !== 'json');
  return (
    <Stack gap="sm">
      <Select
        size="sm"
        label="Size"
        placeholder="Own"
        data={sizes.map(([title, w, h]) => ({ value: title, label: `${title} – ${w} × ${h}` }))}
        value={sizes.find(([, w, h]) => w === size.width && h === size.height)?.[0] ?? null}
        onChange={(title) => {
          const found = sizes.find(([one]) => one === title);
          if (found) setSize({ width: found[1], height: found[2] });
        }}
      />
      <Group grow>
        <NumberInput size="sm" label="Width" suffix=" px" min={1} max={limits?.width} value={size.width} onChange={(w) => typeof w === 'number' && setSize({ ...size, width: w })} data-testid="export-width" />
        <NumberInput size="sm" label="Height" suffix=" px" min={1} max={limits?.height} value={size.height} onChange={(h) => typeof h === 'number' && setSize({ ...size, height: h })} data-testid="export-height" />
      </Group>
      {Math.abs(size.width / size.height / aspect - 1) > 0.01 && <Text size="xs" c="dimmed">Of another shape than the screen: the height of what is seen stays, the width is more or less.</Text>}
      <Group grow>
        <Select size="sm" label="Format" data={formats.map((one) => ({ value: one, label: one.toUpperCase() }))} value={format} allowDeselect={false} onChange={(one) => one && setFormat(one)} />
        <Select size="sm" label="Level" data={(welcome?.levels ?? []).map((one) => ({ value: one, label: labelOf(one) }))} value={level} allowDeselect={false} onChange={(one) => one && setLevel(one)} data-testid="export-level" />
      </Group>
      <Button onClick={() => void startExport({ format, ...size, level }, `${name}, ${size.width} × ${size.height}, ${format.toUpperCase()}`, false)} data-testid="export-start">Render</Button>
      {exports.length > 0 && <Divider />}
      {exports.map((item) => <ExportRow key={item.key} item={item} />)}
    </Stack>
  );
}

function ExportRow({ item }: { item: ExportItem }) {
  const done = item.address !== undefined;
  return (
    <div data-testid="export-item" data-done={done}>
      <Group gap={8} wrap="nowrap">
        <Text size="sm" flex={1} truncate>{item.name ?? item.title}</Text>
        {done && (
          <Button size="compact-sm" variant="light" leftSection={<IconDownload size={15} />} onClick={() => fetchFile(item.address ?? '', item.name ?? 'picture')} data-testid="download">
            {item.bytes !== undefined ? bytes(item.bytes) : 'Download'}
          </Button>
        )}
        <ActionIcon size="sm" aria-label={done || item.problem ? 'Remove from the list' : 'Cancel'} onClick={() => cancelExport(item)}>
          <IconX size={15} />
        </ActionIcon>
      </Group>
      {item.problem ? <Text size="xs" c="red">{item.problem}</Text> : !done && <Progress mt={6} size={6} animated value={Math.max(item.fraction * 100, 1)} aria-label={`Progress of ${item.title}`} />}
    </div>
  );
}
