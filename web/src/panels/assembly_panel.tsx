// The assembly tree: names, search, what is visible. Only the rows that are seen exist, so that thousands of parts are no burden.
import { ActionIcon, Menu, Text, TextInput } from '@mantine/core';
import { IconChevronDown, IconChevronRight, IconCopy, IconDots, IconEye, IconEyeOff, IconFocus2, IconPalette, IconSearch, IconSquareDashed, IconTrash } from '@tabler/icons-react';
import { useVirtualizer } from '@tanstack/react-virtual';
import { memo, useEffect, useMemo, useRef, useState, type KeyboardEvent } from 'react';
import { duplicateSelection, removeSelection } from '../state/edits';
import { hover, select, toggleExpanded, toggleIsolated, toggleVisible } from '../state/selection';
import { get, set, useStore } from '../state/store';
import { nameOf, parentOf, rowsOf, type Row } from '../state/tree';
import { rowHeight } from '../sizes';
import { theStage } from '../view/current_stage';
import { PanelHeader } from './panel_header';


export function AssemblyPanel() {
  const objects = useStore((s) => s.scene?.objects);
  const roots = useStore((s) => s.scene?.roots);
  const expanded = useStore((s) => s.expanded);
  const selection = useStore((s) => s.selection);
  const isolated = useStore((s) => s.isolated !== null);
  const [search, setSearch] = useState('');
  const [active, setActive] = useState<string | null>(null);
  const parent = useRef<HTMLDivElement>(null);
  const rows = useMemo(() => (objects && roots ? rowsOf({ objects, roots }, expanded, search) : []), [objects, roots, expanded, search]);
  const [height] = useState(rowHeight);
  const virtual = useVirtualizer({ count: rows.length, getScrollElement: () => parent.current, estimateSize: () => height, overscan: 8 });

  // What was selected in the picture comes into sight.
  const last = selection[selection.length - 1];
  const at = rows.findIndex((row) => row.path === last);
  useEffect(() => {
    if (last !== undefined) setActive(last);
    if (at >= 0) virtual.scrollToIndex(at, { align: 'auto' });
    // eslint-disable-next-line react-hooks/exhaustive-deps -- scrolls when the selection moves, not whenever the list is drawn
  }, [last]);

  const onKeyDown = (event: KeyboardEvent) => {
    const now = rows.findIndex((row) => row.path === active);
    const row = rows[now] as Row | undefined;
    const go = (index: number) => {
      const next = rows[Math.min(Math.max(index, 0), rows.length - 1)] as Row | undefined;
      if (!next) return;
      setActive(next.path);
      select(next.path, event.shiftKey);
      virtual.scrollToIndex(rows.indexOf(next), { align: 'auto' });
    };
    const act: Record<string, () => void> = {
      ArrowDown: () => go(now + 1),
      ArrowUp: () => go(now - 1),
      Home: () => go(0),
      End: () => go(rows.length - 1),
      ArrowRight: () => row && (row.open || row.object.children.length === 0 ? go(now + 1) : toggleExpanded(row.path)),
      ArrowLeft: () => row && (row.open ? toggleExpanded(row.path) : go(rows.findIndex((one) => one.path === parentOf(row.path)))),
      ' ': () => row && toggleVisible(row.object.index),
      Enter: () => theStage()?.fit(),
    };
    if (!act[event.key]) return;
    event.preventDefault();
    event.stopPropagation();
    act[event.key]();
  };

  return (
    <section className="panel side side-left" aria-label="Assembly" data-testid="assembly">
      <PanelHeader title="Assembly" close={() => set({ leftOpen: false })}>
        <Text size="xs" c="dimmed">{objects?.length ?? 0}</Text>
      </PanelHeader>
      <TextInput m={8} mb={4} placeholder="Search" aria-label="Search parts" value={search} onChange={(event) => setSearch(event.currentTarget.value)} leftSection={<IconSearch size={14} />} />
      {isolated && (
        <Text size="xs" px={12} py={4} c="dimmed">
          Others are hidden. <Text span size="xs" component="button" td="underline" bg="none" bd={0} c="inherit" p={0} onClick={() => void toggleIsolated()}>Show them</Text>
        </Text>
      )}
      <div
        ref={parent}
        className="scroll tree"
        role="tree"
        aria-label="Parts"
        aria-multiselectable
        tabIndex={0}
        aria-activedescendant={active !== null && rows.some((row) => row.path === active) ? `row-${active}` : undefined}
        onKeyDown={onKeyDown}
        onPointerLeave={() => hover(null)}
        style={{ padding: '0 6px 6px' }}
      >
        <div style={{ height: virtual.getTotalSize(), position: 'relative' }}>
          {virtual.getVirtualItems().map((item) => (
            <div key={rows[item.index].path} style={{ position: 'absolute', top: item.start, left: 0, right: 0 }}>
              <TreeRow {...rows[item.index]} />
            </div>
          ))}
        </div>
        {rows.length === 0 && <Text size="sm" c="dimmed" ta="center" mt="md">{search ? 'No part has this name' : 'The scene is empty'}</Text>}
      </div>
    </section>
  );
}

// Drawn anew only where something of it has changed: rows are told by values, and parts that are as they were are the same objects.
const TreeRow = memo(function TreeRow({ path, object, depth, hidden, open }: Row) {
  const selected = useStore((s) => s.selection.includes(path));
  const hovered = useStore((s) => s.hovered === path);
  const name = nameOf(object);
  const Chevron = open ? IconChevronDown : IconChevronRight;
  return (
    <div
      className="row"
      id={`row-${path}`}
      role="treeitem"
      aria-level={depth + 1}
      aria-selected={selected}
      aria-expanded={object.children.length > 0 ? open : undefined}
      data-hovered={hovered}
      data-hidden={hidden}
      style={{ paddingLeft: `${(4 + depth * 14) / 16}rem` }}
      onClick={(event) => select(path, event.ctrlKey || event.metaKey || event.shiftKey)}
      onDoubleClick={() => theStage()?.fit()}
      onPointerEnter={() => hover(path)}
      title={name}
    >
      {object.children.length > 0 ? (
        <ActionIcon size={20} tabIndex={-1} aria-label={open ? `Close ${name}` : `Open ${name}`} onClick={(event) => (event.stopPropagation(), toggleExpanded(path))}>
          <Chevron size={14} />
        </ActionIcon>
      ) : (
        <span style={{ width: '1.25rem' }} />
      )}
      <span className="name">{name}</span>
      <RowMenu path={path} name={name} />
      <ActionIcon className="act" size={22} tabIndex={-1} data-on={!object.visible} aria-label={object.visible ? `Hide ${name}` : `Show ${name}`} onClick={(event) => (event.stopPropagation(), toggleVisible(object.index))}>
        {object.visible ? <IconEye size={15} /> : <IconEyeOff size={15} />}
      </ActionIcon>
    </div>
  );
});

// The menu itself is made when it is first asked for: there are many rows.
function RowMenu({ path, name }: { path: string; name: string }) {
  const [made, setMade] = useState(false);
  const button = (
    <ActionIcon className="act" size={22} tabIndex={-1} aria-label={`More for ${name}`} onClick={(event) => (event.stopPropagation(), setMade(true))}>
      <IconDots size={14} />
    </ActionIcon>
  );
  if (!made) return button;
  const chosen = (then: () => void) => () => {
    if (!get().selection.includes(path)) select(path);
    then();
  };
  return (
    <Menu position="bottom-end" withinPortal defaultOpened>
      <Menu.Target>{button}</Menu.Target>
      <Menu.Dropdown onClick={(event) => event.stopPropagation()}>
        <Menu.Item leftSection={<IconFocus2 size={15} />} onClick={chosen(() => theStage()?.fit())}>Fit</Menu.Item>
        <Menu.Item leftSection={<IconSquareDashed size={15} />} onClick={chosen(() => void toggleIsolated())}>Isolate</Menu.Item>
        <Menu.Item leftSection={<IconPalette size={15} />} onClick={chosen(() => set({ rightOpen: true, rightTab: 'material' }))}>Material</Menu.Item>
        <Menu.Item leftSection={<IconCopy size={15} />} onClick={chosen(() => void duplicateSelection())}>Duplicate</Menu.Item>
        <Menu.Divider />
        <Menu.Item color="red" leftSection={<IconTrash size={15} />} onClick={chosen(() => void removeSelection())}>Delete</Menu.Item>
      </Menu.Dropdown>
    </Menu>
  );
}
