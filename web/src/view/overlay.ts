// What is drawn over the picture, by the same camera: boxes around what is selected and hovered, the outlines of lights, and the handles that move things.
import { Box3, BufferGeometry, Color, Float32BufferAttribute, LineBasicMaterial, LineSegments, Matrix4, Scene, Vector3, WebGLRenderer, type Object3D } from 'three';
import type { ViewCamera } from './camera';

const corner = (i: number) => new Vector3(i & 1, (i >> 1) & 1, (i >> 2) & 1);
const edges = [0, 1, 2, 3].flatMap((i) => [[2 * i, 2 * i + 1], [(i & 1) | ((i & 2) << 1), (i & 1) | ((i & 2) << 1) | 2], [i, i | 4]]).flat();
const unitBox = edges.flatMap((i) => corner(i).toArray());

export class Overlay {
  readonly scene = new Scene();
  private readonly renderer: WebGLRenderer;
  private clear = false; // whether nothing is drawn
  private stale = true; // something of it is other than when it was drawn last
  private readonly drawnBy = new Matrix4(); // view and projection
  private readonly lines = new Map<string, LineSegments<BufferGeometry, LineBasicMaterial>>();

  constructor(canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, alpha: true, antialias: true, powerPreference: 'low-power' });
    this.renderer.setClearColor(0, 0);
  }

  resize(width: number, height: number, ratio: number): void {
    this.renderer.setPixelRatio(Math.min(ratio, 2));
    this.renderer.setSize(width, height, false);
    this.clear = false;
    this.stale = true;
  }

  // What was added looks different.
  changed(): void {
    this.stale = true;
  }

  add(object: Object3D): void {
    this.scene.add(object);
  }

  // Nothing is done where there is nothing to be seen, as mostly while the view turns, and where all is as it was, as while the picture grows.
  render(camera: ViewCamera, handles: boolean): void {
    const empty = this.lines.size === 0 && !handles;
    if (empty && this.clear) return;
    camera.updateMatrixWorld();
    const by = camera.projectionMatrix.clone().multiply(camera.matrixWorldInverse);
    if (!this.stale && by.equals(this.drawnBy)) return;
    this.renderer.render(this.scene, camera);
    this.clear = empty;
    this.stale = false;
    this.drawnBy.copy(by);
  }

  // Lines from pairs of points under a name; those that were there under it go.
  setLines(name: string, points: number[], color: number, opacity: number): void {
    const old = this.lines.get(name);
    if (!old && points.length === 0) return;
    this.stale = true;
    if (old) {
      old.geometry.dispose();
      old.material.dispose();
      old.removeFromParent();
      this.lines.delete(name);
    }
    if (points.length === 0) return;
    const geometry = new BufferGeometry().setAttribute('position', new Float32BufferAttribute(points, 3));
    const material = new LineBasicMaterial({ color: new Color(color), transparent: true, opacity, depthTest: false, depthWrite: false });
    const made = new LineSegments(geometry, material);
    made.frustumCulled = false;
    this.lines.set(name, made);
    this.scene.add(made);
  }

  dispose(): void {
    for (const name of [...this.lines.keys()]) this.setLines(name, [], 0, 0);
    this.renderer.dispose();
  }
}

// The twelve edges of a box that stands in a space of its own.
export function boxLines(box: Box3, world: Matrix4): number[] {
  const size = box.getSize(new Vector3());
  const points: number[] = [];
  const p = new Vector3();
  for (let i = 0; i < unitBox.length; i += 3) {
    p.set(unitBox[i], unitBox[i + 1], unitBox[i + 2]).multiply(size).add(box.min).applyMatrix4(world);
    points.push(p.x, p.y, p.z);
  }
  return points;
}
