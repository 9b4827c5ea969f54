// Fields of a material, a light, the environment or the settings, each with the control for its kind.
import { Group, Select, Stack, Switch, TagsInput, TextInput } from '@mantine/core';
import { linearOf } from '../../color';
import { memo } from 'react';
import { labelOf, unitOf, type Field } from '../../protocol/fields';
import type { Values, Vector } from '../../protocol/messages';
import { ColorField } from './color_field';
import { FieldLabel, NumberField } from './number_field';
import type { Change } from './use_drag';
import { VectorField } from './vector_field';

// The vector with another value on one axis.
const withAxis = (vector: Vector, axis: number, to: number) => vector.map((old, i) => (i === axis ? to : old)) as Vector;

export function FieldList({ fields, values, lengthUnit, onChange }: { fields: Field[]; values: Values; lengthUnit: string; onChange: Change }) {
  return (
    <Stack gap={9}>
      {fields.map((field) => (
        <FieldControl key={field.name} field={field} value={values[field.name] ?? field.default} lengthUnit={lengthUnit} onChange={onChange} />
      ))}
    </Stack>
  );
}

const FieldControl = memo(function FieldControl({ field, value, lengthUnit, onChange }: { field: Field; value: unknown; lengthUnit: string; onChange: Change }) {
  const unit = unitOf(field, lengthUnit);
  const label = labelOf(field.name);
  switch (field.kind) {
    case 'number':
    case 'integer':
      return <NumberField field={field} value={Number(value)} unit={unit} onChange={(x, ongoing) => onChange(field.name, x, ongoing)} />;
    case 'color':
      return <ColorField field={field} value={value} onChange={(x, ongoing) => onChange(field.name, x, ongoing)} />;
    case 'vector':
      return <VectorField field={field} value={linearOf(value) as Vector} unit={unit} onCommit={(axis, to) => onChange(field.name, (now: unknown) => withAxis(linearOf(now ?? field.default) as Vector, axis, to), false)} />;
    case 'boolean':
      return (
        <Group gap={6} wrap="nowrap">
          <FieldLabel field={field} />
          <Switch checked={value === true} aria-label={label} onChange={(event) => onChange(field.name, event.currentTarget.checked, false)} />
        </Group>
      );
    case 'choice':
      return (
        <Group gap={6} wrap="nowrap">
          <FieldLabel field={field} />
          <Select w={140} data={field.choices.map((choice) => ({ value: choice, label: labelOf(choice) }))} value={String(value)} allowDeselect={false} aria-label={label} onChange={(choice) => choice && onChange(field.name, choice, false)} />
        </Group>
      );
    case 'names':
      return <TagsInput size="xs" label={label} description={field.doc} value={Array.isArray(value) ? (value as string[]) : value ? [String(value)] : []} onChange={(names) => onChange(field.name, names, false)} />;
    case 'text':
      return (
        <TextInput
          key={String(value)}
          label={label}
          description={field.doc}
          defaultValue={String(value)}
          onBlur={(event) => event.currentTarget.value !== String(value) && onChange(field.name, event.currentTarget.value, false)}
          onKeyDown={(event) => event.key === 'Enter' && event.currentTarget.blur()}
        />
      );
  }
});
