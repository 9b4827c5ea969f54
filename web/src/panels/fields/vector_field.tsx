// Three numbers.
import { Group, Text } from '@mantine/core';
import { labelOf, type Field } from '../../protocol/fields';
import type { Vector } from '../../protocol/messages';
import { FieldLabel } from './number_field';
import { NumberBox } from './number_box';

const axes = ['x', 'y', 'z'] as const;

export function VectorBoxes({ value, label, unit, onCommit }: { value: Vector; label: string; unit?: string; onCommit: (axis: number, to: number) => void }) {
  return (
    <Group gap={4} wrap="nowrap" grow>
      {axes.map((axis, i) => (
        <NumberBox
          key={axis}
          value={value[i]}
          label={`${label}, ${axis}${unit ? ` (${unit})` : ''}`}
          leftSection={<Text size="xs" c="dimmed">{axis}</Text>}
          onCommit={(x) => onCommit(i, x)}
        />
      ))}
    </Group>
  );
}

export function VectorField({ field, value, unit, onCommit }: { field: Field; value: Vector; unit: string; onCommit: (axis: number, to: number) => void }) {
  return (
    <div>
      <Group gap={4} mb={3} wrap="nowrap">
        <FieldLabel field={field} />
        {unit && <Text size="xs" c="dimmed">{unit}</Text>}
      </Group>
      <VectorBoxes value={value} label={labelOf(field.name)} unit={unit} onCommit={onCommit} />
    </div>
  );
}
