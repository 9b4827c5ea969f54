// The line at the top of a panel.
import { ActionIcon, Group, Text } from '@mantine/core';
import { IconX } from '@tabler/icons-react';
import type { ReactNode } from 'react';

export function PanelHeader({ title, close, children }: { title: string; close?: () => void; children?: ReactNode }) {
  return (
    <Group px={12} py={6} gap={4} wrap="nowrap" style={{ borderBottom: '1px solid var(--line)' }}>
      <Text component="h2" fw={600} size="sm" flex={1} truncate>{title}</Text>
      {children}
      {close && (
        <ActionIcon size="sm" onClick={close} aria-label={`Close ${title}`}>
          <IconX size={15} />
        </ActionIcon>
      )}
    </Group>
  );
}
