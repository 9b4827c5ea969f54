// The kept rays of a pixel, as the tree that they are.
import { Code, Text } from '@mantine/core';
import { useState } from 'react';
import { hexOf, linearOf } from '../color';
import { short } from '../format';
import type { Replayed, Tree, Vector } from '../protocol/messages';
import { useStore } from '../state/store';
import { nameOf, objectAt } from '../state/tree';

export function RayTree({ replayed }: { replayed: Replayed }) {
  if (!replayed.trees?.length) return <Code block mt="xs" fz={11} mah={400} style={{ overflow: 'auto' }}>{replayed.text}</Code>;
  return (
    <div role="tree" aria-label="Rays" style={{ marginTop: 8 }}>
      {replayed.trees.map((tree, i) => <Ray key={i} tree={tree} depth={0} />)}
    </div>
  );
}

function Ray({ tree, depth }: { tree: Tree; depth: number }) {
  const [open, setOpen] = useState(depth < 3);
  const scene = useStore((s) => s.scene);
  const { children = [], ...values } = tree;
  const object = scene && typeof values.object === 'number' ? nameOf(objectAt(scene, values.object)) : null;
  const color = Array.isArray(values.color) ? hexOf(linearOf(values.color) as Vector) : undefined;
  return (
    <div role="treeitem" aria-expanded={children.length > 0 ? open : undefined} className={depth > 0 ? 'ray' : undefined}>
      <Text size="xs" onClick={() => setOpen(!open)} style={{ cursor: children.length > 0 ? 'pointer' : 'default', padding: '2px 0' }}>
        {color && <span style={{ display: 'inline-block', width: 10, height: 10, borderRadius: 3, background: color, marginRight: 6, boxShadow: '0 0 0 1px var(--line)' }} />}
        <b>{String(values.kind ?? 'ray')}</b>
        {object && ` → ${object}`}
        {children.length > 0 && !open && ` (+${children.length})`}
      </Text>
      <Text size="xs" c="dimmed" className="numbers">
        {Object.entries(values)
          .filter(([name]) => !['kind', 'object', 'color'].includes(name))
          .map(([name, value]) => `${name.replaceAll('_', ' ')} ${tellValue(value)}`)
          .join(' · ')}
      </Text>
      {open && children.map((child, i) => <Ray key={i} tree={child} depth={depth + 1} />)}
    </div>
  );
}

function tellValue(value: unknown): string {
  if (typeof value === 'number') return short(value, 3);
  if (Array.isArray(value)) return value.map(tellValue).join(' ');
  if (value !== null && typeof value === 'object') return `(${Object.entries(value).map(([name, one]) => `${name} ${tellValue(one)}`).join(', ')})`;
  return String(value);
}
