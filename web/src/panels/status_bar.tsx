// The bar below: how far the picture has grown, how fast, and pause.
import { Button, Group, Menu, Progress, Text, Tooltip } from '@mantine/core';
import { IconChevronDown } from '@tabler/icons-react';
import { IconPlayerPause, IconPlayerPlay } from '@tabler/icons-react';
import { bytes, count, seconds } from '../format';
import { memo } from 'react';
import { labelOf, settingsFields } from '../protocol/fields';
import type { Progress as Told } from '../protocol/messages';
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
  const level = useStore((s) => s.progress?.level);
  const state = useStore((s) => (!s.progress ? 'starting' : s.progress.paused ? 'paused' : s.progress.done ? 'finished' : 'growing'));
  const paused = useStore((s) => Boolean(s.progress?.paused));
  return (
    <footer className="panel foot" aria-label="Progress of the picture" data-testid="status" data-state={state} data-level={level}>
      <PauseButton paused={paused} />
      <Text size="sm" w={92} truncate>
        {level ? labelOf(level) : '…'}
      </Text>
      <Meter state={state} />
      <UntilMenu />
      <div style={{ flex: 1 }} />
      <Figures />
    </footer>
  );
}

// The parts of the bar are drawn each for itself: ten times a second one of them changes, and rarely all.
const PauseButton = memo(function PauseButton({ paused }: { paused: boolean }) {
  return <ToolButton size="md" label={paused ? 'Go on' : 'Pause'} keys="Space" icon={paused ? IconPlayerPlay : IconPlayerPause} onClick={() => setPaused(!paused)} testId="pause" />;
});

function Meter({ state }: { state: string }) {
  // In tenths of a percent: finer steps are not seen.
  const percent = useStore((s) => (!s.progress ? 0 : s.progress.done ? 100 : Math.min(Math.round(s.progress.fraction * 1000) / 10, 99.9)));
  return (
    <>
      <Progress value={percent} w={{ base: 80, sm: 180 }} size={6} color={state === 'paused' ? 'gray' : 'amber'} aria-label="Progress" />
      <Text size="sm" w={62} ta="right" className="numbers" aria-live="off">
        {state === 'finished' || state === 'paused' ? state : `${percent.toFixed(0)} %`}
      </Text>
    </>
  );
}

const UntilMenu = memo(function UntilMenu() {
  const levels = useStore((s) => s.welcome?.levels);
  const until = useStore((s) => s.progress?.until ?? String(s.scene?.settings.level ?? levelByDefault));
  return (
    <Menu position="top">
      <Menu.Target>
        <Button size="compact-sm" variant="default" rightSection={<IconChevronDown size={13} />} data-testid="until">
          <Text span size="xs" c="dimmed" mr={4}>until</Text> {labelOf(until)}
        </Button>
      </Menu.Target>
      <Menu.Dropdown>
        <Menu.Label>Good enough at</Menu.Label>
        {levels?.map((level) => (
          <Menu.Item key={level} fw={level === until ? 700 : 400} onClick={() => void ask({ until: level })}>
            {labelOf(level)} <Text span size="xs" c="dimmed">– {levelDocs[level]}</Text>
          </Menu.Item>
        ))}
      </Menu.Dropdown>
    </Menu>
  );
});

function Figures() {
  return (
    <Group gap={18} wrap="nowrap" className="numbers">
      <Figure label="Time since the last change" of={(p) => seconds(p.seconds)} />
      <Figure label="Rays a second" of={(p) => `${count(p.rays_per_second)} rays/s`} hidden />
      <Figure label="Rays so far" of={(p) => `${count(p.rays)} rays`} hidden />
      <Figure label="Memory of the kept rays" of={(p) => bytes(p.bytes)} hidden />
    </Group>
  );
}

function Figure({ label, of, hidden }: { label: string; of: (progress: Told) => string; hidden?: boolean }) {
  const value = useStore((s) => s.progress && of(s.progress));
  return value === null ? null : (
    <Tooltip label={label}>
      <Text size="sm" c="dimmed" visibleFrom={hidden ? 'md' : undefined} style={{ whiteSpace: 'nowrap' }}>{value}</Text>
    </Tooltip>
  );
}
