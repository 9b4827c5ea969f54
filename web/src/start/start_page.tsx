// Before a model is open.
import { Group, Loader, Text, Title } from '@mantine/core';
import { useStore } from '../state/store';
import { SchemeButton } from '../panels/top_bar';
import { FileChoices } from './file_choices';

export function StartPage() {
  const ready = useStore((s) => s.welcome !== null);
  const version = useStore((s) => s.welcome?.version);
  return (
    <div className="start">
      <div className="start-inner">
        <Group mb="xl" wrap="nowrap" align="center">
          <img src="./icon.svg" alt="" width={52} height={52} />
          <div style={{ flex: 1 }}>
            <Title order={1} size={30}>Crescente</Title>
            <Text c="dimmed">A picture of your CAD model at once, better at every moment.</Text>
          </div>
          <SchemeButton />
        </Group>
        {ready ? <FileChoices /> : <Group c="dimmed"><Loader size="xs" /> <Text>Connecting to the program</Text></Group>}
        {version && <Text size="xs" c="dimmed" mt="xl">Version {version}</Text>}
      </div>
    </div>
  );
}
