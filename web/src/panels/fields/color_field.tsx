// A colour; of one brighter than white, hue and strength.
import { ColorInput, Group } from '@mantine/core';
import { hexOf, linearOf } from '../../color';
import { labelOf, type Field } from '../../protocol/fields';
import type { Vector } from '../../protocol/messages';
import { FieldLabel } from './number_field';
import { NumberBox } from './number_box';
import { useDraft } from './use_draft';

type Props = { field: Field; value: unknown; onChange: (value: Vector, ongoing: boolean) => void };

export function ColorField({ field, value, onChange }: Props) {
  const color = linearOf(value);
  const strength = Math.max(...color, 1);
  const shown = hexOf(color.map((x) => x / strength) as Vector);
  const draft = useDraft(shown);
  const open = field.maximum === undefined || field.maximum > 1;
  const linear = (hex: string) => linearOf(hex).map((x) => Number((x * strength).toPrecision(5))) as Vector;
  return (
    <Group gap={6} wrap="nowrap">
      <FieldLabel field={field} />
      {open && <NumberBox w={52} value={strength} min={1} label={`${labelOf(field.name)}, strength`} onCommit={(s) => onChange(linearOf(draft.shown).map((x) => x * s) as Vector, false)} />}
      <ColorInput
        w={open ? 104 : 112}
        value={draft.shown}
        aria-label={labelOf(field.name)}
        format="hex"
        withEyeDropper={false}
        onBlur={draft.end}
        popoverProps={{ withinPortal: true }}
        onChange={(hex) => {
          draft.drag(hex);
          if (/^#[0-9a-f]{6}$/i.test(hex) && hex !== shown) onChange(linear(hex), true);
        }}
        onChangeEnd={(hex) => {
          draft.end();
          onChange(linear(hex), false);
        }}
        styles={{ input: { height: '1.625rem', minHeight: '1.625rem' } }}
        data-testid={`color-${field.name}`}
      />
    </Group>
  );
}
