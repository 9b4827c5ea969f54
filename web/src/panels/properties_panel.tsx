// The panel on the right: what one changes.
import { SegmentedControl, Tooltip, VisuallyHidden } from '@mantine/core';
import { IconBulb, IconChartBar, IconCube, IconPalette, IconPhoto, IconVideo, type Icon } from '@tabler/icons-react';
import type { ReactNode } from 'react';
import { set, useStore, type RightTab } from '../state/store';
import { CamerasTab } from './cameras_tab';
import { LightsTab } from './lights_tab';
import { MaterialTab } from './material_tab';
import { NumbersTab } from './numbers_tab';
import { ObjectTab } from './object_tab';
import { StudioTab } from './studio_tab';

const tabs: { tab: RightTab; title: string; icon: Icon; content: () => ReactNode }[] = [
  { tab: 'material', title: 'Materials', icon: IconPalette, content: () => <MaterialTab /> },
  { tab: 'object', title: 'Part', icon: IconCube, content: () => <ObjectTab /> },
  { tab: 'lights', title: 'Lights', icon: IconBulb, content: () => <LightsTab /> },
  { tab: 'studio', title: 'Studio', icon: IconPhoto, content: () => <StudioTab /> },
  { tab: 'cameras', title: 'Cameras', icon: IconVideo, content: () => <CamerasTab /> },
  { tab: 'numbers', title: 'Numbers', icon: IconChartBar, content: () => <NumbersTab /> },
];

export function PropertiesPanel() {
  const tab = useStore((s) => s.rightTab);
  const shown = tabs.find((one) => one.tab === tab) ?? tabs[0];
  return (
    <section className="panel side side-right" aria-label="Properties" data-testid="properties">
      <SegmentedControl
        m={6}
        size="xs"
        value={tab}
        onChange={(next) => set({ rightTab: next as RightTab })}
        aria-label="What is shown"
        data={tabs.map((one) => ({
          value: one.tab,
          label: (
            <Tooltip label={one.title}>
              <span style={{ display: 'grid', placeItems: 'center', padding: '3px 0' }} data-testid={`tab-${one.tab}`}>
                <one.icon size={18} stroke={1.7} />
                <VisuallyHidden>{one.title}</VisuallyHidden>
              </span>
            </Tooltip>
          ),
        }))}
      />
      {shown.content()}
    </section>
  );
}
