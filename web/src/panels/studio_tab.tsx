// Studio, ground, what is behind and around, and how the picture is developed.
import { Button, FileButton, Group, SegmentedControl, Select, Stack, Switch, Text } from '@mantine/core';
import { IconUpload } from '@tabler/icons-react';
import { environmentFields, labelOf, settingsFields } from '../protocol/fields';
import { edit, setEnvironmentField, setSetting } from '../state/edits';
import { chooseEnvironment, uploadEnvironment } from '../state/files';
import { useShallow } from 'zustand/react/shallow';
import { get, useStore } from '../state/store';
import { FieldList } from './fields/field_list';
import { GroupedFields } from './fields/grouped_fields';
import { useDrag } from './fields/use_drag';
import { PanelHeader } from './panel_header';

const pick = (fields: typeof environmentFields, names: string[]) => names.map((name) => fields.find((field) => field.name === name)).filter((field) => field !== undefined);

export function StudioTab() {
  const scene = useStore(useShallow((s) => s.scene && { environment: s.scene.environment, settings: s.scene.settings, studio: s.scene.studio, ground: s.scene.ground, unit: s.scene.unit }));
  const studios = useStore((s) => s.welcome?.studios) ?? [];
  const environments = useStore((s) => s.files?.environments) ?? [];
  const changeEnvironment = useDrag(setEnvironmentField, (field) => `Environment: ${field.replaceAll('_', ' ')}`, () => get().scene && (get().scene?.environment ?? {}));
  const changeSetting = useDrag(setSetting, (field) => `Picture: ${field.replaceAll('_', ' ')}`, () => get().scene?.settings);
  if (!scene) return null;
  const environment = scene.environment ?? {};
  const image = String(environment.image ?? '');
  const known = environments.find((one) => image !== '' && image.endsWith(one.title));
  const hasImage = image !== '' || Boolean(environment.sky);
  return (
    <div className="scroll">
      <Stack className="section" gap={9}>
        <Select label="Studio" placeholder="The scene's own lights" data={studios.map((name) => ({ value: name, label: labelOf(name) }))} value={scene.studio ?? null} onChange={(name) => name && void edit({ studio: name }, `Studio: ${labelOf(name)}`)} data-testid="studio" />
        {scene.ground !== undefined && (
          <div>
            <Text size="xs" mb={3}>Ground</Text>
            <SegmentedControl fullWidth size="xs" aria-label="Ground" value={scene.ground} onChange={(ground) => void edit({ ground }, `Ground: ${ground}`)} data={[{ value: 'solid', label: 'Solid' }, { value: 'catch', label: 'Shadow only' }, { value: 'none', label: 'None' }]} />
          </div>
        )}
        <Group gap={6} wrap="nowrap">
          <Text size="xs" flex={1}>Transparent background</Text>
          <Switch aria-label="Transparent background" checked={environment.transparent === true} onChange={(event) => changeEnvironment('transparent', event.currentTarget.checked, false)} />
        </Group>
      </Stack>
      <PanelHeader title="Environment" />
      <Stack className="section" gap={9}>
        <Select
          label="Surroundings"
          data={[{ value: '', label: 'Gradient or sky' }, ...environments.map((one) => ({ value: one.file, label: one.title })), ...(image && !known ? [{ value: image, label: image.slice(image.lastIndexOf('/') + 1) }] : [])]}
          value={known ? known.file : image}
          allowDeselect={false}
          onChange={(file) => void chooseEnvironment(file || null)}
        />
        <FileButton accept=".hdr,.exr" inputProps={{ 'aria-label': 'Picture of surroundings' }} onChange={(file) => file && void uploadEnvironment(file)}>
          {(props) => <Button {...props} variant="default" size="xs" leftSection={<IconUpload size={14} />}>Picture of surroundings (.hdr, .exr)</Button>}
        </FileButton>
        {hasImage && <FieldList fields={pick(environmentFields, ['rotation', 'intensity'])} values={environment} lengthUnit={scene.unit} onChange={changeEnvironment} />}
        <GroupedFields
          fields={environmentFields.filter((field) => !['image', 'transparent', ...(hasImage ? ['rotation', 'intensity'] : [])].includes(field.name))}
          first={[]}
          groups={[{ title: 'Backdrop', names: /^backdrop/ }, { title: 'Gradient', names: /^(zenith|horizon|nadir|strength|directions)$/ }, { title: 'Sky', names: /^(sky|rotation|intensity)$/ }]}
          values={environment}
          lengthUnit={scene.unit}
          onChange={changeEnvironment}
        />
      </Stack>
      <PanelHeader title="Picture" />
      <section className="section">
        <GroupedFields
          fields={settingsFields.filter((field) => !['width', 'height', 'level', 'threads', 'memory', 'tile', 'keep', 'order'].includes(field.name))}
          first={['exposure', 'auto_exposure', 'tonemap']}
          groups={[{ title: 'Quality', names: /^(threshold|depth|supersampling|contrast|noise|samples|caustics|denoise)$/ }, { title: 'How rays find objects', names: /./ }]}
          values={scene.settings}
          lengthUnit={scene.unit}
          onChange={changeSetting}
        />
      </section>
    </div>
  );
}
