// The bar below: how far the picture has grown, how fast, and pause.
import { Button, Group, Menu, Progress, Text, Tooltip } from '@mantine/core';
import { IconChevronDown } from '@tabler/icons-react';
import { IconPlayerPause, IconPlayerPlay } from '@tabler/icons-react';
import { bytes, count, seconds } from '../format';
import { labelOf, settingsFields } from '../protocol/fields';
import { ask } from '../state/session';
import { useStore } from '../state/store';
import { setPaused } from '../view/shortcuts';
import { ToolButton } from './tool_button';

const levelByDefault = settingsFields.find((field) => field.name === 'level')?.default;

const levelDocs: Record<string, string> = {
  visible: 'What is seen, in local light',
  shadows: 'Shadows of all lights',
  reflections: 'Mirrors and glass',
  edges: 'Smooth edges',
  soft: 'Soft light, glossy surfaces, free of noise',
  indirect: 'Light between surfaces',
};

export function StatusBar() {
  const progress = useStore((s) => s.progress);
  const levels = useStore((s) => s.welcome?.levels) ?? [];
  const settingsLevel = useStore((s) => String(s.scene?.settings.level ?? levelByDefault));
  const until = progress?.until ?? settingsLevel;
  const state = !progress ? 'starting' : progress.paused ? 'paused' : progress.done ? 'finished' : 'growing';
  const percent = progress ? (progress.done ? 100 : Math.min(progress.fraction * 100, 99.9)) : 0;
  return (
    <footer className="panel foot" aria-label="Progress of the picture" data-testid="status" data-state={state} data-level={progress?.level}>
      <ToolButton size="md" label={progress?.paused ? 'Go on' : 'Pause'} keys="Space" icon={progress?.paused ? IconPlayerPlay : IconPlayerPause} onClick={() => setPaused(!progress?.paused)} testId="pause" />
      <Text size="sm" w={92} truncate>
        {progress ? labelOf(progress.level) : '…'}
      </Text>
      <Progress value={percent} w={{ base: 80, sm: 180 }} size={6} color={progress?.paused ? 'gray' : 'amber'} aria-label="Progress" />
      <Text size="sm" w={62} ta="right" className="numbers" aria-live="off">
        {state === 'finished' ? 'finished' : state === 'paused' ? 'paused' : `${percent.toFixed(0)} %`}
      </Text>
      <Menu position="top">
        <Menu.Target>
          <Button size="compact-sm" variant="default" rightSection={<IconChevronDown size={13} />} data-testid="until">
            <Text span size="xs" c="dimmed" mr={4}>until</Text> {labelOf(until)}
          </Button>
        </Menu.Target>
        <Menu.Dropdown>
          <Menu.Label>Good enough at</Menu.Label>
          {levels.map((level) => (
            <Menu.Item key={level} fw={level === until ? 700 : 400} onClick={() => void ask({ until: level })}>
              {labelOf(level)} <Text span size="xs" c="dimmed">– {levelDocs[level]}</Text>
            </Menu.Item>
          ))}
        </Menu.Dropdown>
      </Menu>
      <div style={{ flex: 1 }} />
      {progress && (
        <Group gap={18} wrap="nowrap" className="numbers">
          <Figure label="Time since the last change" value={seconds(progress.seconds)} />
          <Figure label="Rays a second" value={`${count(progress.rays_per_second)} rays/s`} hidden />
          <Figure label="Rays so far" value={`${count(progress.rays)} rays`} hidden />
          <Figure label="Memory of the kept rays" value={bytes(progress.bytes)} hidden />
        </Group>
      )}
    </footer>
  );
}

function Figure({ label, value, hidden }: { label: string; value: string; hidden?: boolean }) {
  return (
    <Tooltip label={label}>
      <Text size="sm" c="dimmed" visibleFrom={hidden ? 'md' : undefined} style={{ whiteSpace: 'nowrap' }}>{value}</Text>
    </Tooltip>
  );
}
