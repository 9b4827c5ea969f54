// Keys and pointer.
import { Kbd, Modal, SimpleGrid, Table, Text, Title } from '@mantine/core';
import { set, useStore } from '../state/store';
import { shortcuts } from '../view/shortcuts';

const pointer: [string, string][] = [
  ['Drag', 'Turn around the point under the pointer'],
  ['Right drag, Shift drag', 'Pan'],
  ['Wheel', 'Zoom to the pointer'],
  ['Click', 'Select a part; with Ctrl more'],
  ['Double click', 'Fit the part'],
  ['Drop a material', 'The part gets it'],
  ['One finger', 'Turn'],
  ['Two fingers', 'Zoom and pan'],
];

export function HelpDialog() {
  const open = useStore((s) => s.dialog === 'help');
  const groups = [...new Set(shortcuts.map((one) => one.group))];
  return (
    <Modal opened={open} onClose={() => set({ dialog: null })} title={<Text fw={600}>Keys and pointer</Text>} size="xl">
      <SimpleGrid cols={{ base: 1, sm: 2 }} spacing="xl">
        <Lines title="Pointer" lines={pointer} plain />
        {groups.map((group) => (
          <Lines key={group} title={group} lines={shortcuts.filter((one) => one.group === group).map((one) => [one.shown, one.title])} />
        ))}
      </SimpleGrid>
    </Modal>
  );
}

function Lines({ title, lines, plain }: { title: string; lines: [string, string][]; plain?: boolean }) {
  return (
    <section>
      <Title order={5} mb={4}>{title}</Title>
      <Table verticalSpacing={3} horizontalSpacing={4} withRowBorders={false}>
        <Table.Tbody>
          {lines.map(([key, what]) => (
            <Table.Tr key={key}>
              <Table.Td w={150}>{plain ? <Text size="sm" c="dimmed">{key}</Text> : <Kbd>{key}</Kbd>}</Table.Td>
              <Table.Td>{what}</Table.Td>
            </Table.Tr>
          ))}
        </Table.Tbody>
      </Table>
    </section>
  );
}
