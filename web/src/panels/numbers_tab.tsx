// Numbers for the curious: what an edit cost, what is kept, heat maps, and the rays of a pixel.
import { Button, Progress, SegmentedControl, Table, Text } from '@mantine/core';
import { bytes, count, seconds } from '../format';
import { labelOf } from '../protocol/fields';
import { ask, send } from '../state/session';
import { set, useStore } from '../state/store';
import { PanelHeader } from './panel_header';
import { RayTree } from './ray_tree';

const layerDocs: Record<string, string> = {
  color: 'The picture',
  samples: 'How many samples each pixel has',
  influence: 'What is still to come, by what it can change',
  level: 'How far each pixel has grown',
};

export function NumbersTab() {
  const progress = useStore((s) => s.progress);
  const lastEdit = useStore((s) => s.lastEdit);
  const layer = useStore((s) => s.layer);
  const layers = useStore((s) => s.welcome?.layers) ?? [];
  const pixel = useStore((s) => s.pixel);
  const replayed = useStore((s) => s.replayed);
  const replaying = useStore((s) => s.replaying);
  const showLayer = (next: string) => {
    if (send({ layer: next })) set({ layer: next });
  };
  const replay = async () => {
    if (!pixel) return;
    set({ replaying: true });
    const answer = await ask({ replay: pixel });
    set({ replaying: false, replayed: answer?.replayed ?? null });
  };
  return (
    <div className="scroll">
      <section className="section" data-testid="numbers" data-edit-rays={progress?.edit_rays} data-edit-camera-rays={progress?.edit_camera_rays} data-fresh-rays={progress?.fresh_rays ?? undefined}>
        <Text size="sm" fw={600} component="h3" mb={4}>{lastEdit ? `Last edit: ${lastEdit}` : 'No edit yet'}</Text>
        {progress && lastEdit && <EditCost edit={progress.edit_rays} fresh={progress.fresh_rays} />}
      </section>
      {progress && (
        <section className="section">
          <Table verticalSpacing={3} horizontalSpacing={0} withRowBorders={false} className="numbers" fz="xs">
            <Table.Tbody>
              <Line name="Time" value={seconds(progress.seconds)} />
              <Line name="Rays" value={count(progress.rays)} />
              <Line name="Rays a second" value={count(progress.rays_per_second)} />
              <Line name="Kept nodes" value={count(progress.nodes)} />
              <Line name="Kept memory" value={bytes(progress.bytes)} />
            </Table.Tbody>
          </Table>
        </section>
      )}
      <PanelHeader title="What the picture shows" />
      <section className="section">
        <SegmentedControl fullWidth size="xs" aria-label="What the picture shows" value={layer} onChange={showLayer} data={layers.map((one) => ({ value: one, label: labelOf(one) }))} data-testid="layers" />
        <Text size="xs" c="dimmed" mt={6}>{layerDocs[layer] ?? ''}</Text>
      </section>
      <PanelHeader title="Rays of a pixel" />
      <section className="section">
        {pixel ? (
          <Button size="xs" variant="default" loading={replaying} onClick={() => void replay()} data-testid="replay">Show the rays of pixel {pixel.x}, {pixel.y}</Button>
        ) : (
          <Text size="sm" c="dimmed">Click a place in the picture.</Text>
        )}
        {replayed && <RayTree replayed={replayed} />}
      </section>
    </div>
  );
}

function EditCost({ edit, fresh }: { edit: number; fresh: number | null }) {
  if (fresh === null || fresh === 0) return <Text size="xs" c="dimmed">{count(edit)} rays traced</Text>;
  const share = (100 * edit) / fresh;
  return (
    <>
      <Text size="xs" className="numbers">{count(edit)} rays traced · a fresh picture takes {count(fresh)}</Text>
      <Progress mt={6} size={8} value={Math.max(share, edit > 0 ? 0.5 : 0)} color="amber" aria-label="Rays of the edit as share of a fresh picture's" />
      <Text size="xs" c="dimmed" mt={4}>{edit === 0 ? 'nothing: what was kept was shaded anew' : share < 0.05 ? 'less than 0.1 %' : `${share.toFixed(1)} %`}</Text>
    </>
  );
}

function Line({ name, value }: { name: string; value: string }) {
  return (
    <Table.Tr>
      <Table.Td c="dimmed">{name}</Table.Td>
      <Table.Td ta="right">{value}</Table.Td>
    </Table.Tr>
  );
}
