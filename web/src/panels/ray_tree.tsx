// The kept rays of a pixel, as the tree that they are.
import { Code, Text } from '@mantine/core';
import { useState } from 'react';
import { hexOf, linearOf } from '../color';
import { short } from '../format';
import type { Replayed, Tree } from '../protocol/messages';
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
  const children = tree.children ?? [];
  const [open, setOpen] = useState(depth < 3);
  const scene = useStore((s) => s.scene);
  const object = scene && tree.object !== null ? nameOf(objectAt(scene, tree.object)) : null;
  const material = scene && typeof tree.material === 'number' ? scene.materials[tree.material]?.name : undefined;
  const facts = [
    material,
    tree.distance !== undefined ? `after ${short(tree.distance, 3)} ${scene?.unit ?? ''}` : 'left the scene',
    `influence ${triple(tree.influence)}`,
    tree.inside ? 'from inside' : null,
    tree.not_grown?.length ? `${tree.not_grown.length} not grown` : null,
  ];
  return (
    <div role="treeitem" aria-expanded={children.length > 0 ? open : undefined} aria-selected={false} className={depth > 0 ? 'ray' : undefined} title={tree.position && `at ${triple(tree.position)}, face ${tree.face}`}>
      <Text size="xs" onClick={() => setOpen(!open)} style={{ cursor: children.length > 0 ? 'pointer' : 'default', paddingTop: 4 }}>
        <span style={{ display: 'inline-block', width: 10, height: 10, borderRadius: 3, background: hexOf(linearOf(tree.color)), marginRight: 6, boxShadow: '0 0 0 1px var(--line)' }} />
        <b>{tree.kind}</b>
        {tree.at && ` ${short(tree.at[0])}, ${short(tree.at[1])}`}
        {object && ` → ${object}`}
        {children.length > 0 && !open && ` (+${children.length})`}
      </Text>
      <Text size="xs" c="dimmed" className="numbers">{facts.filter(Boolean).join(' · ')}</Text>
      {byKind(tree.lights ?? []).map(([told, count]) => (
        <Text key={told} size="xs" c="dimmed" pl={16} className="numbers">{told}{count > 1 && ` (${count} points)`}</Text>
      ))}
      {open && children.map((child, i) => <Ray key={i} tree={child} depth={depth + 1} />)}
    </div>
  );
}

const triple = (values: number[]) => (values.every((x) => x === values[0]) ? short(values[0], 3) : values.map((x) => short(x, 3)).join(' '));

// Lights with extent are seen as many points: those of one light that are alike are told once.
function byKind(lights: NonNullable<Tree['lights']>): [string, number][] {
  const counts = new Map<string, number>();
  for (const { name, light, state, share } of lights) {
    const told = `${name || `light ${light}`}: ${state}, share ${triple(share)}`;
    counts.set(told, (counts.get(told) ?? 0) + 1);
  }
  return [...counts];
}
