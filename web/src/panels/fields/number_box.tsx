// A number that is taken when one has finished typing it: with Enter, or on leaving.
import { NumberInput, type NumberInputProps } from '@mantine/core';
import { useEffect, useState } from 'react';
import { decimal } from '../../format';

type Props = { value: number; onCommit: (value: number) => void; label: string; unit?: string; digits?: number } & Pick<NumberInputProps, 'min' | 'max' | 'w' | 'leftSection' | 'allowDecimal' | 'step' | 'disabled'>;

export function NumberBox({ value, onCommit, label, unit, digits = 4, ...rest }: Props) {
  const [text, setText] = useState<string | number>(decimal(value, digits));
  useEffect(() => setText(decimal(value, digits)), [value, digits]);
  const commit = () => {
    const next = typeof text === 'number' ? text : Number.parseFloat(text);
    if (Number.isFinite(next) && decimal(next, digits) !== decimal(value, digits)) onCommit(next);
    else setText(decimal(value, digits));
  };
  return (
    <NumberInput
      {...rest}
      value={text}
      onChange={setText}
      onBlur={commit}
      onKeyDown={(event) => {
        if (event.key === 'Enter') commit();
        if (event.key === 'Escape') setText(decimal(value, digits));
      }}
      suffix={unit ? ` ${unit}` : undefined}
      aria-label={label}
      hideControls
      styles={{ input: { height: '1.5rem', minHeight: '1.5rem', textAlign: 'right', paddingInline: '0.375rem', fontVariantNumeric: 'tabular-nums' } }}
    />
  );
}
