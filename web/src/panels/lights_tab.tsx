// Lights: the list, new ones, and the fields of the one that is chosen.
import { ActionIcon, Button, Menu, Text } from '@mantine/core';
import { IconPlus, IconTrash } from '@tabler/icons-react';
import { memo } from 'react';
import { hexOf, linearOf } from '../color';
import { short } from '../format';
import { labelOf, lightFields } from '../protocol/fields';
import type { Named, Vector } from '../protocol/messages';
import { edit, removeSelection, setLightField } from '../state/edits';
import { newLight, lightKinds } from '../state/lights';
import { get, set, useStore } from '../state/store';
import { theStage } from '../view/current_stage';
import { GroupedFields, type FieldGroup } from './fields/grouped_fields';
import { useDrag } from './fields/use_drag';

const firstOf: Record<string, string[]> = {
  point: ['intensity', 'color', 'position', 'direction', 'inner_angle', 'outer_angle'],
  directional: ['intensity', 'color', 'direction'],
  rectangle: ['intensity', 'color', 'width', 'height', 'position', 'direction', 'visible'],
  disk: ['intensity', 'color', 'radius', 'position', 'direction', 'visible'],
  sphere: ['intensity', 'color', 'radius', 'position', 'visible'],
};
const groups: FieldGroup[] = [
  { title: 'Falloff', names: /^(falloff|constant|linear|quadratic|range)$/ },
  { title: 'Cone', names: /^(inner_angle|outer_angle|gradient|exponent)$/ },
  { title: 'What it lights', names: /^(only|except|shadows|highlights)$/ },
];

export function LightsTab() {
  const lights = useStore((s) => s.scene?.lights);
  const lengthUnit = useStore((s) => s.scene?.unit ?? '');
  const chosen = useStore((s) => s.light);
  if (!lights) return null;
  const light = chosen !== null ? lights[chosen] : undefined;
  return (
    <div className="scroll">
      <section className="section">
        {lights.length === 0 && <Text size="sm" c="dimmed" mb="xs">No lights: the environment alone shines.</Text>}
        <div role="list" aria-label="Lights" data-testid="lights">
          {lights.map((one, index) => (
            <LightRow key={index} light={one} index={index} chosen={index === chosen} />
          ))}
        </div>
        <Menu position="bottom-start">
          <Menu.Target>
            <Button mt={8} fullWidth size="xs" variant="default" leftSection={<IconPlus size={15} />}>Add a light</Button>
          </Menu.Target>
          <Menu.Dropdown>
            {lightKinds.map(({ kind, title }) => (
              <Menu.Item key={kind} onClick={() => void add(kind)}>{title}</Menu.Item>
            ))}
          </Menu.Dropdown>
        </Menu>
      </section>
      {light && chosen !== null && (
        <section className="section">
          <Text size="xs" c="dimmed" mb="xs">Drag the arrows in the picture to move it, with the rotate tool (R) to aim it; the small squares set its cone or its size.</Text>
          <LightEditor key={chosen} light={light} index={chosen} lengthUnit={lengthUnit} />
        </section>
      )}
    </div>
  );
}

async function add(kind: string): Promise<void> {
  const { scene } = get();
  if (!scene) return;
  const light = newLight(scene, kind, (place) => theStage()?.intoSight(place) ?? place);
  // It comes after those that are there.
  const index = scene.lights.length;
  if (await edit({ light }, 'Add light')) set({ light: index, selection: [] });
}

const LightRow = memo(function LightRow({ light, index, chosen }: { light: Named; index: number; chosen: boolean }) {
  const color = linearOf(light.color ?? 1);
  const most = Math.max(...color, 1e-9);
  const choose = () => set({ light: index, selection: [] });
  return (
    <div className="row" role="listitem" data-chosen={chosen}>
      <button type="button" className="choose" aria-pressed={chosen} onClick={choose}>
        <span style={{ width: '0.75rem', height: '0.75rem', borderRadius: '50%', marginInline: '0.25rem', background: hexOf(color.map((x) => x / most) as Vector), boxShadow: '0 0 0 1px var(--line)' }} />
        <span className="name">{light.name || `Light ${index + 1}`}</span>
        <Text size="xs" c="dimmed">{labelOf(String(light.kind ?? 'point'))} · {short(Number(light.intensity ?? 1), 3)}</Text>
      </button>
      <ActionIcon className="act" size={22} aria-label={`Delete light ${light.name || index + 1}`} onClick={() => (choose(), void removeSelection())}>
        <IconTrash size={14} />
      </ActionIcon>
    </div>
  );
});

// The unit of brightness is that of the kind.
const fieldsWith = (unit: string) => lightFields.map((field) => (field.name === 'intensity' ? { ...field, unit } : field));
const fieldsOfSun = fieldsWith('lx');
const fieldsOfLamp = fieldsWith('cd');

function LightEditor({ light, index, lengthUnit }: { light: Named; index: number; lengthUnit: string }) {
  const onChange = useDrag((field, value) => setLightField(index, field, value), (field) => `${light.name || 'Light'}: ${field.replaceAll('_', ' ')}`, () => get().scene?.lights[index]);
  const fields = light.kind === 'directional' ? fieldsOfSun : fieldsOfLamp;
  return <GroupedFields fields={fields} first={firstOf[String(light.kind ?? 'point')] ?? firstOf.point} groups={groups} values={light} lengthUnit={lengthUnit} onChange={onChange} />;
}
