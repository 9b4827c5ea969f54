// The selected part: where it stands, by numbers, and what can be done with it.
import { Button, Group, Stack, Text } from '@mantine/core';
import { IconCopy, IconEyeOff, IconFocus2, IconSquareDashed, IconTrash } from '@tabler/icons-react';
import { MathUtils } from 'three';
import type { Scene, Vector } from '../protocol/messages';
import { short } from '../format';
import { duplicateSelection, editInTurn, removeSelection } from '../state/edits';
import { placementOf, movedTo, turnedTo } from '../state/placement';
import { hideSelection, toggleIsolated } from '../state/selection';
import { useShallow } from 'zustand/react/shallow';
import { get, useStore } from '../state/store';
import { leafOf, nameOf, objectAt, rowsOfMatrix, worldBox } from '../state/tree';
import { theStage } from '../view/current_stage';
import { VectorBoxes } from './fields/vector_field';

export function ObjectTab() {
  const scene = useStore(useShallow((s) => s.scene && { objects: s.scene.objects, unit: s.scene.unit }));
  const selection = useStore((s) => s.selection);
  const path = selection.at(-1);
  const object = scene && path !== undefined ? objectAt(scene, leafOf(path)) : undefined;
  if (!scene || !object || path === undefined) return <Text className="section" size="sm" c="dimmed">Click a part in the picture or in the assembly.</Text>;
  const { position, degrees } = placementOf(object);
  // What was typed, in place of what is there by the time.
  const place = (what: 'position' | 'degrees', axis: number, to: number) =>
    void editInTurn(
      () => {
        const { scene: now } = get();
        const there = now && objectAt(now, object.index);
        if (!there) return null;
        const values = placementOf(there)[what].map((old, i) => (i === axis ? to : old)) as Vector;
        const transform = what === 'position' ? movedTo(there, values) : turnedTo(there, values.map(MathUtils.degToRad) as Vector);
        return { move: { object: there.index, transform: { matrix: rowsOfMatrix(transform) } } };
      },
      what === 'position' ? 'Move' : 'Rotate',
    );
  return (
    <div className="scroll">
      <section className="section">
        <Text fw={600} size="sm" component="h3">{nameOf(object)}</Text>
        <Text size="xs" c="dimmed">{describe(scene, path)}</Text>
      </section>
      <Stack className="section" gap={8}>
        <div>
          <Text size="xs" mb={3}>Position <Text span c="dimmed">{scene.unit}</Text></Text>
          <VectorBoxes value={position} label="Position" unit={scene.unit} onCommit={(axis, to) => place('position', axis, to)} />
        </div>
        <div>
          <Text size="xs" mb={3}>Rotation <Text span c="dimmed">degrees, about its middle</Text></Text>
          <VectorBoxes value={degrees} label="Rotation" unit="degrees" onCommit={(axis, to) => place('degrees', axis, to)} />
        </div>
      </Stack>
      <Group className="section" gap={6} grow preventGrowOverflow={false} wrap="nowrap">
        <Button variant="default" size="xs" px={8} leftSection={<IconFocus2 size={15} />} onClick={() => theStage()?.fit()}>Fit</Button>
        <Button variant="default" size="xs" px={8} leftSection={<IconSquareDashed size={15} />} onClick={() => void toggleIsolated()}>Isolate</Button>
        <Button variant="default" size="xs" px={8} leftSection={<IconEyeOff size={15} />} onClick={hideSelection}>Hide</Button>
      </Group>
      <Group className="section" gap={6} grow>
        <Button variant="default" size="xs" px={8} leftSection={<IconCopy size={15} />} onClick={() => void duplicateSelection()}>Duplicate</Button>
        <Button variant="default" size="xs" px={8} c="red" leftSection={<IconTrash size={15} />} onClick={() => void removeSelection()}>Delete</Button>
      </Group>
    </div>
  );
}

function describe(scene: Pick<Scene, 'objects' | 'unit'>, path: string): string {
  const object = objectAt(scene, leafOf(path));
  const box = worldBox(scene, path);
  const parts = [
    (object?.shape === 'brep' ? 'CAD part' : object?.shape) ?? `${object?.children.length ?? 0} parts`,
    object?.faces ? `${object.faces} faces` : object?.triangles ? `${object.triangles.toLocaleString('en')} triangles` : null,
    box && !box.isEmpty() ? `${box.max.clone().sub(box.min).toArray().map((x) => short(x, 3)).join(' × ')} ${scene.unit}` : null,
  ];
  return parts.filter(Boolean).join(' · ');
}
