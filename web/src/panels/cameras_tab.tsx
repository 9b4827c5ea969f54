// Kept views, and the lens.
import { ActionIcon, Button, Group, Stack, Switch, Text, TextInput } from '@mantine/core';
import { IconPlus, IconRefresh, IconTrash } from '@tabler/icons-react';
import { useState } from 'react';
import { keepCameras, keptCameras, type KeptCamera } from '../state/cameras';
import { set, useStore } from '../state/store';
import { theStage } from '../view/current_stage';
import { NumberBox } from './fields/number_box';

export function CamerasTab() {
  const model = useStore((s) => s.scene?.file ?? '');
  const orthographic = useStore((s) => s.orthographic);
  const [cameras, setCameras] = useState(() => keptCameras(model));
  const [name, setName] = useState('');
  const [angle, setAngle] = useState(() => theStage()?.navigation.get().field_of_view ?? 40);
  const change = (next: KeptCamera[]) => {
    setCameras(next);
    keepCameras(model, next);
  };
  const keep = () => {
    const camera = theStage()?.navigation.get();
    if (!camera) return;
    change([...cameras, { name: name.trim() || `View ${cameras.length + 1}`, camera }]);
    setName('');
  };
  const show = ({ camera }: KeptCamera) => {
    theStage()?.navigation.set(camera);
    set({ orthographic: camera.projection === 'orthographic' });
  };
  return (
    <div className="scroll">
      <Stack className="section" gap={8}>
        <Group gap={6} wrap="nowrap">
          <TextInput flex={1} placeholder="Name of this view" aria-label="Name of this view" value={name} onChange={(event) => setName(event.currentTarget.value)} onKeyDown={(event) => event.key === 'Enter' && keep()} />
          <Button size="xs" leftSection={<IconPlus size={14} />} onClick={keep}>Keep</Button>
        </Group>
        {cameras.length === 0 && <Text size="sm" c="dimmed">Views that you keep are listed here, for this model, in this browser.</Text>}
        <div role="list" aria-label="Kept views">
          {cameras.map((one, index) => (
            <div key={index} className="row" role="listitem">
              <Button variant="subtle" color="gray" size="compact-sm" flex={1} justify="flex-start" onClick={() => show(one)}>{one.name}</Button>
              <ActionIcon className="act" size={24} aria-label={`Put the present view into ${one.name}`} title="Put the present view here" onClick={() => change(cameras.map((old, i) => (i === index ? { ...old, camera: theStage()?.navigation.get() ?? old.camera } : old)))}>
                <IconRefresh size={14} />
              </ActionIcon>
              <ActionIcon className="act" size={24} aria-label={`Delete ${one.name}`} onClick={() => change(cameras.filter((_, i) => i !== index))}>
                <IconTrash size={14} />
              </ActionIcon>
            </div>
          ))}
        </div>
      </Stack>
      <Stack className="section" gap={8}>
        <Group gap={6} wrap="nowrap">
          <Text size="xs" flex={1}>Orthographic</Text>
          <Switch aria-label="Orthographic" checked={orthographic} onChange={(event) => set({ orthographic: event.currentTarget.checked })} />
        </Group>
        <Group gap={6} wrap="nowrap">
          <Text size="xs" flex={1}>Vertical angle of view</Text>
          <NumberBox w={92} value={angle} min={1} max={120} unit="°" label="Vertical angle of view" onCommit={(degrees) => (setAngle(degrees), theStage()?.navigation.setFieldOfView(degrees))} />
        </Group>
      </Stack>
    </div>
  );
}
