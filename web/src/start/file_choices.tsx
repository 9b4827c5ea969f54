// Models at hand: upload, folders that the program allows, recent ones, examples.
import { Alert, Anchor, Breadcrumbs, Button, FileButton, Group, SimpleGrid, Stack, Text, Title, UnstyledButton } from '@mantine/core';
import { IconAlertTriangle, IconClock, IconCube, IconFile3d, IconFolder, IconUpload } from '@tabler/icons-react';
import type { ReactNode } from 'react';
import { bytes } from '../format';
import { listFolder, openFile, receiveFiles } from '../state/files';
import { useStore } from '../state/store';

const join = (folder: string | null, name: string) => (folder === null ? name : `${folder.replace(/\/$/, '')}/${name}`);

export function FileChoices() {
  const files = useStore((s) => s.files);
  const limit = useStore((s) => s.welcome?.limits.upload);
  const failure = useStore((s) => s.openFailure);
  const recent = (files?.recent ?? []).slice(0, 8);
  const examples = files?.examples ?? [];
  return (
    <Stack gap="lg">
      {failure && (
        <Alert color="red" variant="light" icon={<IconAlertTriangle />} title={<Text span inherit c="var(--mantine-color-text)">{failure.file.replace(/^upload\//, '')} could not be opened</Text>} role="alert" data-testid="open-failure">
          {failure.failure.problems.map((problem, i) => (
            <Text key={i} size="sm">{[problem.place, problem.reason, problem.hint].filter(Boolean).join(' – ')}</Text>
          ))}
        </Alert>
      )}
      <Group className="card" justify="space-between" style={{ borderStyle: 'dashed' }}>
        <div>
          <Text fw={600}>Drop a model here</Text>
          <Text size="sm" c="dimmed">STEP, IGES, BREP, glTF, STL, OBJ, PLY, scenes{limit ? ` · up to ${bytes(limit)}` : ''}</Text>
        </div>
        <FileButton onChange={(list) => void receiveFiles(list)} multiple inputProps={{ 'aria-label': 'Model to open' }}>
          {(props) => <Button {...props} leftSection={<IconUpload size={16} />}>Choose a file</Button>}
        </FileButton>
      </Group>
      <SimpleGrid cols={{ base: 1, sm: 2 }} spacing="lg">
        {examples.length > 0 && (
          <Choices title="Examples">
            {examples.map((one) => <Choice key={one.name} icon={<IconCube size={18} />} name={one.title} testId="example" onClick={() => void openFile(one.file)} />)}
          </Choices>
        )}
        {recent.length > 0 && (
          <Choices title="Recent">
            {recent.map((one) => <Choice key={one.name} icon={<IconClock size={18} />} name={one.title} detail={one.file} onClick={() => void openFile(one.file)} />)}
          </Choices>
        )}
        {files && (files.folders.length > 0 || files.files.length > 0 || files.folder) && (
          <Choices title="Folders" header={<FolderPath folder={files.folder} />}>
            {files.folders.map((name) => <Choice key={name} icon={<IconFolder size={18} />} name={name} onClick={() => void listFolder(join(files.folder, name))} />)}
            {files.files.map((one) => <Choice key={one.name} icon={<IconFile3d size={18} />} name={one.title} detail={one.bytes !== undefined ? bytes(one.bytes) : undefined} testId="file" onClick={() => void openFile(one.file)} />)}
            {files.folders.length + files.files.length === 0 && <Text size="sm" c="dimmed" px={12} py={8}>No models in this folder</Text>}
          </Choices>
        )}
      </SimpleGrid>
    </Stack>
  );
}

function FolderPath({ folder }: { folder: string | null }) {
  if (!folder) return null;
  return (
    <Breadcrumbs separatorMargin={4} px={12} pb={4}>
      <Anchor component="button" size="sm" onClick={() => void listFolder(null)}>All folders</Anchor>
      <Text size="sm" truncate>{folder}</Text>
    </Breadcrumbs>
  );
}

function Choices({ title, header, children }: { title: string; header?: ReactNode; children: ReactNode }) {
  return (
    <section className="card" style={{ padding: '12px 6px 8px' }} aria-label={title}>
      <Title order={2} size="sm" fw={600} px={12} mb={6}>{title}</Title>
      {header}
      <div style={{ maxHeight: '21rem', overflowY: 'auto' }}>{children}</div>
    </section>
  );
}

function Choice({ icon, name, detail, onClick, testId }: { icon: ReactNode; name: string; detail?: string; onClick: () => void; testId?: string }) {
  return (
    <UnstyledButton className="choice" onClick={onClick} data-testid={testId}>
      {icon}
      <Text size="sm" flex={1} truncate>{name}</Text>
      {detail && <Text size="xs" c="dimmed" truncate maw="55%">{detail}</Text>}
    </UnstyledButton>
  );
}
