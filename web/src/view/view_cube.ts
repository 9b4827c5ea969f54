// The cube that shows how the view stands and turns it: three-viewport-gizmo on a canvas of its own.
import { WebGLRenderer } from 'three';
import { ViewportGizmo } from 'three-viewport-gizmo';
import { rem } from '../sizes';
import type { Navigation } from './navigation';


export class ViewCube {
  private readonly renderer: WebGLRenderer;
  private readonly gizmo: ViewportGizmo;

  constructor(container: HTMLElement, private readonly navigation: Navigation, moved: () => void) {
    const size = rem(6.5); // of its place
    this.renderer = new WebGLRenderer({ alpha: true, antialias: true });
    this.renderer.setClearColor(0, 0);
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(size, size);
    this.renderer.domElement.className = 'cube';
    container.append(this.renderer.domElement);
    const face = { scale: 0.96, color: 0x39434d, labelColor: 0xf2f4f6, hover: { color: 0xd9982b, labelColor: 0x111111 } };
    this.gizmo = new ViewportGizmo(navigation.camera, this.renderer, {
      container,
      type: 'cube',
      size,
      offset: { left: 0, right: 0, top: 0, bottom: 0 },
      speed: 2,
      font: { family: 'system-ui, sans-serif', weight: 600 },
      radius: 0.12,
      background: { enabled: false },
      corners: { enabled: false },
      edges: { enabled: false },
      right: { ...face, label: 'Right' },
      left: { ...face, label: 'Left' },
      top: { ...face, label: 'Top' },
      bottom: { ...face, label: 'Bottom' },
      front: { ...face, label: 'Front' },
      back: { ...face, label: 'Back' },
    });
    this.gizmo.addEventListener('start', () => {
      this.gizmo.target.copy(navigation.pivot);
      navigation.controls.enabled = false;
    });
    this.gizmo.addEventListener('end', () => {
      navigation.controls.enabled = true;
    });
    this.gizmo.addEventListener('change', () => {
      const { x, y, z } = navigation.camera.position;
      void navigation.controls.setPosition(x, y, z, false);
      moved();
    });
  }

  // True while it turns the view by itself.
  draw(): boolean {
    this.gizmo.camera = this.navigation.camera;
    if (!this.gizmo.animating) this.gizmo.update(false);
    this.renderer.clear();
    this.gizmo.render();
    return this.gizmo.animating;
  }

  dispose(): void {
    this.gizmo.dispose();
    this.renderer.dispose();
    this.renderer.domElement.remove();
  }
}
