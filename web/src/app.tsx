// The page: the view with its panels once a model is open, before that the start page.
import { Button, Loader, Paper, Stack, Text, Title } from '@mantine/core';
import { AssemblyPanel } from './panels/assembly_panel';
import { Banner } from './panels/banner';
import { ExportDialog } from './panels/export_dialog';
import { HelpDialog } from './panels/help_dialog';
import { PropertiesPanel } from './panels/properties_panel';
import { StatusBar } from './panels/status_bar';
import { TopBar } from './panels/top_bar';
import { connection } from './state/session';
import { useStore } from './state/store';
import { OpenDialog } from './start/open_dialog';
import { DropAnywhere } from './start/drop_anywhere';
import { StartPage } from './start/start_page';
import { useShortcuts } from './view/use_shortcuts';
import { Viewport } from './view/viewport';

export function App() {
  useShortcuts();
  const hasScene = useStore((s) => s.scene !== null);
  const opening = useStore((s) => s.opening);
  const closedReason = useStore((s) => (s.connection === 'closed' ? (s.closedReason ?? 'the program has ended') : null));
  const leftOpen = useStore((s) => s.leftOpen);
  const rightOpen = useStore((s) => s.rightOpen);
  return (
    <main className={`app ${rightOpen && hasScene ? 'with-right' : ''}`}>
      {hasScene ? (
        <>
          <Viewport />
          <TopBar />
          {leftOpen && <AssemblyPanel />}
          {rightOpen && <PropertiesPanel />}
          <StatusBar />
        </>
      ) : (
        !opening && <StartPage />
      )}
      <Banner />
      <DropAnywhere />
      <HelpDialog />
      <ExportDialog />
      <OpenDialog />
      {opening && (
        <div className="cover" role="status">
          <Stack align="center" gap="sm">
            <Loader type="dots" />
            <Text fw={500}>Opening {opening.slice(opening.lastIndexOf('/') + 1)}</Text>
          </Stack>
        </div>
      )}
      {closedReason && (
        <div className="cover">
          <Paper p="xl" maw={420} withBorder role="alertdialog" aria-label="The session has ended">
            <Title order={3}>The session has ended</Title>
            <Text my="md" c="dimmed">{closedReason}</Text>
            <Button onClick={() => connection.restart()}>Start again</Button>
          </Paper>
        </div>
      )}
    </main>
  );
}
