// The bar above: files, undo, tools, views.
import { Button, Divider, Menu, Text, useComputedColorScheme, useMantineColorScheme } from '@mantine/core';
import { IconArrowBackUp, IconArrowForwardUp, IconArrowsMove, IconBinaryTree2, IconCamera, IconChevronDown, IconClipboard, IconCube, IconDeviceFloppy, IconFolderOpen, IconHelp, IconLayoutSidebarRight, IconMagnet, IconMaximize, IconMoon, IconPerspective, IconPhotoDown, IconPointer, IconRotate360, IconRotateClockwise, IconSun } from '@tabler/icons-react';
import { useShallow } from 'zustand/react/shallow';
import { redo, undo } from '../state/edits';
import { copyPicture } from '../state/copy_picture';
import { startExport } from '../state/exports';
import { titleOf } from '../state/session';
import { set, useStore, type Tool } from '../state/store';
import { theStage } from '../view/current_stage';
import type { StandardView } from '../view/navigation';
import { ToolButton } from './tool_button';

const views: [StandardView, string][] = [['front', '1'], ['back', '2'], ['right', '3'], ['left', '4'], ['top', '5'], ['bottom', '6'], ['isometric', '0']];

export function TopBar() {
  const name = useStore((s) => (s.scene ? titleOf(s.scene) : ''));
  const canUndo = useStore((s) => Boolean(s.scene?.can_undo));
  const canRedo = useStore((s) => Boolean(s.scene?.can_redo));
  const { tool, snap, orthographic, turntable, leftOpen, rightOpen } = useStore(useShallow(({ tool, snap, orthographic, turntable, leftOpen, rightOpen }) => ({ tool, snap, orthographic, turntable, leftOpen, rightOpen })));
  const toolButton = (own: Tool) => ({ active: tool === own, onClick: () => set({ tool: own }) });
  return (
    <header className="panel bar" role="toolbar" aria-label="Tools">
      <Menu position="bottom-start">
        <Menu.Target>
          <Button variant="subtle" color="gray" px={8} leftSection={<img src="./icon.svg" alt="" width={20} height={20} />} rightSection={<IconChevronDown size={14} />} data-testid="file-menu">
            File
          </Button>
        </Menu.Target>
        <Menu.Dropdown>
          <Menu.Item leftSection={<IconFolderOpen size={16} />} rightSection={<Text size="xs" c="dimmed">Ctrl O</Text>} onClick={() => set({ dialog: 'open' })}>Open…</Menu.Item>
          <Menu.Item leftSection={<IconDeviceFloppy size={16} />} onClick={() => void startExport({ format: 'json', width: 0, height: 0, level: '' }, `${name}.json`, true)}>Save scene (JSON)</Menu.Item>
          <Menu.Divider />
          <Menu.Item leftSection={<IconPhotoDown size={16} />} rightSection={<Text size="xs" c="dimmed">Ctrl E</Text>} onClick={() => set({ dialog: 'export' })}>Export picture…</Menu.Item>
          <Menu.Item leftSection={<IconClipboard size={16} />} onClick={() => void copyPicture()}>Copy picture</Menu.Item>
        </Menu.Dropdown>
      </Menu>
      <ToolButton label="Undo" keys="Ctrl Z" icon={IconArrowBackUp} disabled={!canUndo} onClick={() => void undo()} testId="undo" />
      <ToolButton label="Redo" keys="Ctrl Y" icon={IconArrowForwardUp} disabled={!canRedo} onClick={() => void redo()} testId="redo" />
      <Divider orientation="vertical" mx={4} my={10} />
      <ToolButton label="Select" keys="S" icon={IconPointer} {...toolButton('select')} />
      <ToolButton label="Move" keys="M" icon={IconArrowsMove} {...toolButton('move')} />
      <ToolButton label="Rotate" keys="R" icon={IconRotateClockwise} {...toolButton('rotate')} />
      <ToolButton label="Snap to steps" keys="N" icon={IconMagnet} active={snap} onClick={() => set({ snap: !snap })} />
      <Text className="title" ta="center" size="sm" fw={500} truncate px="sm" title={name} component="h1">{name}</Text>
      <Menu position="bottom">
        <Menu.Target>
          <Button variant="subtle" color="gray" px={8} leftSection={<IconCube size={18} stroke={1.7} />} rightSection={<IconChevronDown size={14} />} aria-label="Views"><span className="bar-label">Views</span></Button>
        </Menu.Target>
        <Menu.Dropdown>
          {views.map(([view, key]) => (
            <Menu.Item key={view} tt="capitalize" rightSection={<Text size="xs" c="dimmed">{key}</Text>} onClick={() => theStage()?.look(view)}>{view}</Menu.Item>
          ))}
        </Menu.Dropdown>
      </Menu>
      <ToolButton label="Fit" keys="F" icon={IconMaximize} onClick={() => theStage()?.fit()} testId="fit" />
      <ToolButton label="Orthographic" keys="P" icon={IconPerspective} active={orthographic} onClick={() => set({ orthographic: !orthographic })} testId="orthographic" />
      <ToolButton label="Turntable" keys="T" icon={IconRotate360} active={turntable} onClick={() => set({ turntable: !turntable })} visibleFrom="sm" />
      <ToolButton label="Export picture" keys="Ctrl E" icon={IconCamera} onClick={() => set({ dialog: 'export' })} />
      <Divider orientation="vertical" mx={4} my={10} />
      <ToolButton label="Assembly" icon={IconBinaryTree2} active={leftOpen} onClick={() => set({ leftOpen: !leftOpen })} testId="toggle-assembly" />
      <ToolButton label="Properties" icon={IconLayoutSidebarRight} active={rightOpen} onClick={() => set({ rightOpen: !rightOpen })} testId="toggle-properties" />
      <SchemeButton />
      <ToolButton label="Keys and pointer" keys="?" icon={IconHelp} onClick={() => set({ dialog: 'help' })} />
    </header>
  );
}

export function SchemeButton() {
  const { setColorScheme } = useMantineColorScheme();
  const scheme = useComputedColorScheme('dark');
  const other = scheme === 'dark' ? 'light' : 'dark';
  return <ToolButton label={other === 'dark' ? 'Dark colours' : 'Light colours'} icon={scheme === 'dark' ? IconSun : IconMoon} onClick={() => setColorScheme(other)} />;
}
