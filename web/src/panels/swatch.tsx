// A material as a ball of its colour, to click and to drag.
import { Tooltip } from '@mantine/core';
import { materialType } from '../view/pointer';

type Props = { name: string; hint?: string; color: string; metal: boolean; pressed?: boolean; drag: string; onClick: () => void };

export function Swatch({ name, hint, color, metal, pressed, drag, onClick }: Props) {
  return (
    <Tooltip label={hint ? `${name}: ${hint}` : name} multiline maw={260} openDelay={700}>
      <button
        type="button"
        className="swatch"
        draggable
        aria-pressed={pressed}
        aria-label={name}
        onClick={onClick}
        onDragStart={(event) => {
          event.dataTransfer.setData(materialType, drag);
          event.dataTransfer.effectAllowed = 'copy';
        }}
      >
        <span className={metal ? 'ball metal' : 'ball'} style={{ background: color }} />
        <span className="label">{name}</span>
      </button>
    </Tooltip>
  );
}
