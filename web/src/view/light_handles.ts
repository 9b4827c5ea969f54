// Handles over the picture for what shapes a light: the cones of a spot, the size of a light with extent (the larger, the softer its shadows). Each is a slider of one value that runs along
// a straight line in space: dragged by the pointer, stepped by the arrow keys.
import { MathUtils, Vector3 } from 'three';
import { callName, Drag } from '../state/edits';
import type { Store } from '../state/store';
import { boxOf } from '../state/tree';
import type { Named, Values } from '../protocol/messages';
import { rayThrough, type ViewCamera, type WholeCamera } from './camera';
import { axesOfLight } from './light_lines';

// A place on a line, and the value that it stands for. Along the line from origin, by `side` (of unit length).
type Line = { origin: Vector3; side: Vector3; valueAt(along: number): number; alongOf(value: number): number };
type Kind = { field: string; title: string; unit: string; largest: number; otherwise: number; line(light: Values, reach: number, seenFrom: Vector3): Line };

const widest = 89; // degrees: half a cone that can be drawn as one

const cone = (field: string, title: string, otherwise: number): Kind => ({
  field,
  title,
  unit: '°',
  largest: widest,
  otherwise,
  line(light, reach, seenFrom) {
    const { position, direction } = axesOfLight(light);
    // On that rim of the cone where it is seen from the side.
    const side = direction.clone().cross(seenFrom.clone().sub(position));
    if (side.lengthSq() < 1e-12) side.copy(axesOfLight(light).right);
    return {
      origin: position.addScaledVector(direction, reach),
      side: side.normalize().multiplyScalar(field === 'inner_angle' ? -1 : 1), // opposite to each other, so that neither covers the other
      valueAt: (along) => MathUtils.radToDeg(Math.atan2(Math.max(along, 0), reach)),
      alongOf: (angle) => reach * Math.tan(MathUtils.degToRad(angle)),
    };
  },
});

const extent = (field: string, title: string, otherwise: number, whole: number, side: (light: Values, seenFrom: Vector3) => Vector3): Kind => ({
  field,
  title,
  unit: '',
  largest: Infinity,
  otherwise,
  line: (light, _reach, seenFrom) => ({ origin: axesOfLight(light).position, side: side(light, seenFrom), valueAt: (along) => Math.max(along, 0) * whole, alongOf: (value) => value / whole }),
});

function kindsOf(light: Values): Kind[] {
  const kinds: Kind[] = [];
  const outer = typeof light.outer_angle === 'number' ? light.outer_angle : 180;
  if (outer <= widest && light.kind !== 'directional' && light.kind !== 'sphere') kinds.push(cone('outer_angle', 'Cone', 180), cone('inner_angle', 'Full light within the cone', 0));
  if (light.kind === 'disk') kinds.push(extent('radius', 'Radius', 0.5, 1, (of) => axesOfLight(of).right));
  if (light.kind === 'sphere') {
    kinds.push(extent('radius', 'Radius', 0.5, 1, (of, seenFrom) => {
      const across = seenFrom.clone().sub(axesOfLight(of).position).cross(new Vector3(0, -1, 0));
      return across.lengthSq() < 1e-12 ? new Vector3(1, 0, 0) : across.normalize();
    }));
  }
  if (light.kind === 'rectangle') kinds.push(extent('width', 'Width', 1, 2, (of) => axesOfLight(of).right), extent('height', 'Height', 1, 2, (of) => axesOfLight(of).above));
  return kinds;
}

// What an edit of one value sets: full light ends within the cone.
export function setShape(light: Values, name: string, field: string, value: number): Values {
  const set: Values = { [`light.${name}.${field}`]: value };
  const { inner_angle: inner = 0, outer_angle: outer = 180 } = light as { inner_angle?: number; outer_angle?: number };
  if (field === 'outer_angle' && inner > value) set[`light.${name}.inner_angle`] = value;
  if (field === 'inner_angle' && value > outer) set[`light.${name}.${field}`] = outer;
  return set;
}

// Where along the line the ray passes it by: the foot of their common perpendicular. Null where they are about parallel.
function nearestAlong(line: Line, ray: { origin: Vector3; direction: Vector3 }): number | null {
  const between = ray.origin.clone().sub(line.origin);
  const cosine = ray.direction.dot(line.side);
  const sine2 = 1 - cosine * cosine;
  if (sine2 < 1e-6) return null;
  return (between.dot(line.side) - between.dot(ray.direction) * cosine) / sine2;
}

const round = (x: number) => Number(x.toPrecision(4));

export class LightHandles {
  private readonly handles = new Map<string, HTMLElement>();
  private state: Store | null = null;
  private held: { kind: Kind; drag: Drag } | null = null;

  // cameraNow: by which the picture is seen.
  constructor(private readonly element: HTMLElement, private readonly cameraNow: () => WholeCamera) {}

  private get light(): { light: Named; name: string; reach: number } | null {
    const { scene, light: index } = this.state ?? {};
    const light = scene && typeof index === 'number' ? scene.lights[index] : undefined;
    if (!scene || !light || typeof index !== 'number') return null;
    return { light, name: callName(light, index), reach: scene.bounds ? boxOf(scene.bounds).getSize(new Vector3()).length() / 2 : 1 };
  }

  refresh(state: Store): void {
    this.state = state;
    const now = this.light;
    const kinds = now ? kindsOf(now.light) : [];
    for (const [field, handle] of this.handles) {
      if (kinds.some((kind) => kind.field === field)) continue;
      handle.remove();
      this.handles.delete(field);
    }
    for (const kind of kinds) {
      let handle = this.handles.get(kind.field);
      if (!handle) this.handles.set(kind.field, (handle = this.make(kind)));
      const value = this.valueOf(kind);
      handle.ariaValueNow = String(value);
      handle.ariaValueText = `${value} ${kind.unit || (state.scene?.unit ?? '')}`;
      handle.title = `${kind.title}: ${handle.ariaValueText}`;
    }
  }

  place(camera: ViewCamera, size: { width: number; height: number }): void {
    const now = this.light;
    if (!now) return;
    for (const kind of kindsOf(now.light)) {
      const handle = this.handles.get(kind.field);
      if (!handle) continue;
      const line = kind.line(now.light, now.reach, camera.position);
      const at = line.origin.addScaledVector(line.side, line.alongOf(this.valueOf(kind)));
      const behind = at.clone().applyMatrix4(camera.matrixWorldInverse).z >= 0;
      const seen = at.project(camera);
      handle.hidden = behind || Math.abs(seen.x) > 1 || Math.abs(seen.y) > 1;
      handle.style.transform = `translate(${((seen.x + 1) / 2) * size.width}px, ${((1 - seen.y) / 2) * size.height}px) translate(-50%, -50%)`;
    }
  }

  dispose(): void {
    for (const handle of this.handles.values()) handle.remove();
  }

  private valueOf(kind: Kind): number {
    const value = this.light?.light[kind.field];
    return typeof value === 'number' ? value : kind.otherwise;
  }

  private make(kind: Kind): HTMLElement {
    const handle = document.createElement('div');
    handle.className = 'light-handle';
    handle.dataset.field = kind.field;
    handle.tabIndex = 0;
    handle.role = 'slider';
    handle.ariaLabel = kind.title;
    handle.ariaValueMin = '0';
    if (Number.isFinite(kind.largest)) handle.ariaValueMax = String(kind.largest);
    handle.addEventListener('pointerdown', (event) => {
      event.stopPropagation();
      if (event.button !== 0) return;
      handle.setPointerCapture(event.pointerId);
      this.held = { kind, drag: new Drag(kind.title) };
    });
    handle.addEventListener('pointermove', (event) => {
      event.stopPropagation();
      if (this.held?.kind === kind) this.dragTo(event.clientX, event.clientY);
    });
    for (const end of ['pointerup', 'pointercancel'] as const) {
      handle.addEventListener(end, (event) => {
        event.stopPropagation();
        this.held = null;
      });
    }
    handle.addEventListener('keydown', (event) => {
      const steps: Record<string, number> = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 };
      if (!steps[event.key]) return;
      event.preventDefault();
      event.stopPropagation();
      const value = this.valueOf(kind);
      this.change(kind, value + steps[event.key] * (kind.unit ? 1 : value / 20 || 0.01), new Drag(kind.title));
    });
    this.element.append(handle);
    return handle;
  }

  private dragTo(clientX: number, clientY: number): void {
    const now = this.light;
    if (!now || !this.held) return;
    const rect = this.element.getBoundingClientRect();
    const camera = this.cameraNow();
    const ray = rayThrough(camera, rect.width / rect.height, (clientX - rect.left) / rect.width, (clientY - rect.top) / rect.height);
    const line = this.held.kind.line(now.light, now.reach, new Vector3(...camera.position));
    const along = nearestAlong(line, ray);
    if (along !== null) this.change(this.held.kind, line.valueAt(along), this.held.drag);
  }

  private change(kind: Kind, value: number, drag: Drag): void {
    const now = this.light;
    if (now) void drag.send({ set: setShape(now.light, now.name, kind.field, round(MathUtils.clamp(value, 0, kind.largest))) });
  }
}
