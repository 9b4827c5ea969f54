// A button with an icon and the key that does the same.
import { ActionIcon, Tooltip, type ActionIconProps } from '@mantine/core';
import type { Icon } from '@tabler/icons-react';

type Props = ActionIconProps & { label: string; keys?: string; icon: Icon; onClick: () => void; active?: boolean; testId?: string };

export function ToolButton({ label, keys, icon: Shape, onClick, active, testId, ...rest }: Props) {
  return (
    <Tooltip label={keys ? `${label} (${keys})` : label}>
      <ActionIcon aria-label={label} aria-pressed={active} onClick={onClick} data-testid={testId} {...(active ? { variant: 'light', color: 'amber' } : {})} {...rest}>
        <Shape size={19} stroke={1.7} />
      </ActionIcon>
    </Tooltip>
  );
}
