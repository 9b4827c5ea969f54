// Materials: the one of the selection, with a control for every field; the scene's; the library's.
import { Badge, Group, Text, TextInput } from '@mantine/core';
import { IconSearch } from '@tabler/icons-react';
import { memo, useEffect, useState } from 'react';
import { hexOf, swatchOf } from '../color';
import { fieldsOfMaterial } from '../protocol/fields';
import type { LibraryMaterial, Named } from '../protocol/messages';
import { setMaterialField } from '../state/edits';
import { applyLibrary, applyMaterial, dragOfLibrary, dragOfMaterial } from '../state/materials';
import { get, useStore } from '../state/store';
import { materialOf } from '../state/tree';
import { GroupedFields, type FieldGroup } from './fields/grouped_fields';
import { useDrag } from './fields/use_drag';
import { PanelHeader } from './panel_header';
import { Swatch } from './swatch';

const physicalFirst = ['base_color', 'metallic', 'roughness', 'ior', 'transmission'];
const classicFirst = ['diffuse', 'specular', 'shininess', 'reflection', 'transmission', 'ior'];
const groups: FieldGroup[] = [
  { title: 'Clear coat', names: /^clearcoat/ },
  { title: 'Light of its own', names: /^emissi/ },
  { title: 'Glass', names: /^(dispersion|attenuation)$/ },
  { title: 'Reflection', names: /^specular/ },
  { title: 'Metal, measured', names: /^(eta|k)$/ },
  { title: 'Brushed', names: /^(anisotropy|grain)/ },
  { title: 'Cloth', names: /^sheen/ },
  { title: 'Thin film', names: /^iridescence/ },
  { title: 'Opacity', names: /^(opacity|double_sided|catcher)$/ },
];

export function MaterialTab() {
  const materials = useStore((s) => s.scene?.materials);
  const lengthUnit = useStore((s) => s.scene?.unit ?? '');
  const path = useStore((s) => s.selection.at(-1) ?? null);
  const own = useStore((s) => (s.scene && path !== null ? materialOf(s.scene, path) : null));
  const [chosen, setChosen] = useState<number | null>(null);
  useEffect(() => setChosen(own), [own, path]);
  if (!materials) return null;
  const edited = chosen !== null ? materials[chosen] : undefined;
  return (
    <div className="scroll">
      {edited && chosen !== null ? (
        <section className="section">
          <MaterialEditor key={chosen} material={edited} index={chosen} lengthUnit={lengthUnit} />
        </section>
      ) : (
        <Text className="section" size="sm" c="dimmed">Click a part in the picture, or choose a material below.</Text>
      )}
      <PanelHeader title="In this scene" />
      <div className="section swatches" data-testid="scene-materials">
        {materials.map((material, index) => (
          <SceneMaterial key={index} material={material} index={index} pressed={index === chosen} applies={path !== null && index !== own} choose={setChosen} />
        ))}
      </div>
      <Library />
    </div>
  );
}

const SceneMaterial = memo(function SceneMaterial({ material, index, pressed, applies, choose }: { material: Named; index: number; pressed: boolean; applies: boolean; choose: (index: number) => void }) {
  return <Swatch name={material.name || `Material ${index}`} {...swatchOf(material)} pressed={pressed} drag={dragOfMaterial(material, index)} onClick={() => (applies ? void applyMaterial(material, index) : choose(index))} />;
});

const Library = memo(function Library() {
  const library = useStore((s) => s.welcome?.library);
  const selected = useStore((s) => s.selection.length > 0);
  const [search, setSearch] = useState('');
  if (!library) return null;
  const found = library.filter((one) => one.name.includes(search.trim().toLowerCase()));
  return (
    <>
      <PanelHeader title="Library">
        <TextInput size="xs" w={130} placeholder="Search" aria-label="Search the library" value={search} onChange={(event) => setSearch(event.currentTarget.value)} leftSection={<IconSearch size={13} />} styles={{ input: { height: 26, minHeight: 26 } }} />
      </PanelHeader>
      <Text size="xs" c="dimmed" px={12} pt={6}>{selected ? 'Click to apply to the selection, or drag onto a part.' : 'Drag onto a part in the picture.'}</Text>
      {byGroup(found).map(([group, materials]) => (
        <section key={group} className="section" style={{ borderBottom: 0 }}>
          <Text size="xs" c="dimmed" mb={4} fw={500}>{group}</Text>
          <div className="swatches">
            {materials.map((material) => (
              <Swatch key={material.name} name={material.name} hint={material.note} color={hexOf(material.color)} metal={/metal|alumin/i.test(group)} drag={dragOfLibrary(material.name)} onClick={() => void applyLibrary(material.name)} />
            ))}
          </div>
        </section>
      ))}
      {found.length === 0 && <Text p="md" size="sm" c="dimmed" ta="center">The library has no such material</Text>}
    </>
  );
});

function MaterialEditor({ material, index, lengthUnit }: { material: Named; index: number; lengthUnit: string }) {
  const onChange = useDrag((field, value) => setMaterialField(index, field, value), (field) => `${material.name || 'Material'}: ${field.replaceAll('_', ' ')}`, () => get().scene?.materials[index]);
  const fields = fieldsOfMaterial(material);
  const textures = material.textures && typeof material.textures === 'object' ? Object.keys(material.textures) : [];
  return (
    <>
      <Group gap={8} mb={10} wrap="nowrap">
        <span style={{ width: '1.375rem', height: '1.375rem', borderRadius: '50%', background: swatchOf(material).color, boxShadow: '0 0 0 1px var(--line)' }} />
        <Text fw={600} size="sm" flex={1} truncate component="h3" title={material.name}>{material.name || `Material ${index}`}</Text>
        {material.model === 'classic' && <Badge size="sm" variant="default">classic</Badge>}
      </Group>
      <GroupedFields fields={fields} first={material.model === 'classic' ? classicFirst : physicalFirst} groups={groups} values={material} lengthUnit={lengthUnit} onChange={onChange} />
      {textures.length > 0 && <Text size="xs" c="dimmed" mt="xs">Textures act on {textures.join(', ')}.</Text>}
    </>
  );
}

function byGroup(materials: LibraryMaterial[]): [string, LibraryMaterial[]][] {
  const found = new Map<string, LibraryMaterial[]>();
  for (const material of materials) found.set(material.group, [...(found.get(material.group) ?? []), material]);
  return [...found];
}
