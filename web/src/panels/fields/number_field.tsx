// A number with its slider.
import { Group, Slider, Text, Tooltip } from '@mantine/core';
import { useEffect, useState } from 'react';
import { labelOf, type Field } from '../../protocol/fields';
import { NumberBox } from './number_box';
import { useDraft } from './use_draft';
import { sliderRange } from './usual_ranges';

type Props = { field: Field; value: number; unit: string; onChange: (value: number, ongoing: boolean) => void };

export function NumberField({ field, value, unit, onChange }: Props) {
  const draft = useDraft(value);
  // The range of the slider rests while it is dragged.
  const [settled, setSettled] = useState(value);
  useEffect(() => {
    if (draft.shown === value) setSettled(value);
  }, [value, draft.shown]);
  const [low, high] = sliderRange(field, settled);
  const whole = field.kind === 'integer';
  const step = whole ? 1 : (high - low) / 200;
  const round = (x: number) => (whole ? Math.round(x) : Number(x.toPrecision(4)));
  return (
    <div>
      <Group gap={6} wrap="nowrap">
        <FieldLabel field={field} />
        <NumberBox value={draft.shown} label={labelOf(field.name)} unit={unit} min={field.minimum} max={field.maximum} w={92} allowDecimal={!whole} onCommit={(x) => onChange(x, false)} />
      </Group>
      <Slider
        mt={5}
        mb={3}
        min={low}
        max={high}
        step={step}
        value={draft.shown}
        thumbLabel={labelOf(field.name)}
        onChange={(x) => {
          draft.drag(round(x));
          onChange(round(x), true);
        }}
        onChangeEnd={(x) => {
          draft.end();
          onChange(round(x), false);
        }}
        data-testid={`slider-${field.name}`}
      />
    </div>
  );
}

export function FieldLabel({ field }: { field: Field }) {
  return (
    <Tooltip label={field.doc} multiline maw={280} position="left">
      <Text size="xs" flex={1} truncate>{labelOf(field.name)}</Text>
    </Tooltip>
  );
}
