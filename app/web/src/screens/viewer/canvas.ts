// SPDX-License-Identifier: Apache-2.0
// A canvas that shows the scene of a viewer: by WebGL, or by pictures of the daemon where there is none.
import {effect, type Signal, signal} from '@preact/signals';
import {type ApiError, asApiError} from '../../api/client';
import {GlPainter} from '../../gl/gl_painter';
import type {Painter} from '../../gl/painter';
import {PlainPainter} from '../../gl/plain_painter';
import type {Viewer} from './viewer';

const ARRIVALS_MS = 100;

export type Means = 'webgl' | 'pictures' | 'lost' | 'none';

/** What is shown of a viewer. */
export type Shown = {readonly [part in 'scene' | 'canvas' | 'isComing']: Pick<Viewer[part], 'value' | 'peek'>};

export class PictureCanvas {
  readonly means: Signal<Means> = signal<Means>('none');
  readonly failure = signal<ApiError | null>(null);
  private painter: Painter | null = null;
  private frame = 0;
  /** Until what has arrived is drawn; 0: nothing waits. */
  private pause = 0;
  /** Nothing but tiles is awaited. */
  private isFinal = false;
  private readonly ends: (() => void)[] = [];

  constructor(
    readonly element: HTMLCanvasElement,
    private readonly viewer: Shown,
  ) {
    this.begin();
    this.listen('webglcontextlost', (event) => this.lose(event));
    this.listen('webglcontextrestored', () => this.begin());
    this.ends.push(
      effect(() => {
        this.follow();
      }),
    );
  }

  close(): void {
    this.ends.forEach((end) => end());
    cancelAnimationFrame(this.frame);
    clearTimeout(this.pause);
    this.painter?.close();
  }

  retry(): void {
    this.painter?.retry();
    this.schedule();
  }

  /** What is seen now, drawn at once, so that it can be copied. */
  drawNow(): HTMLCanvasElement {
    this.paint();
    return this.element;
  }

  private begin(): void {
    const arrived = () => this.takeArrival();
    this.painter = GlPainter.on(this.element, arrived);
    this.means.value = this.painter ? 'webgl' : 'none';
    const context = this.painter ? null : this.element.getContext('2d');
    if (context) {
      this.painter = new PlainPainter(context, arrived);
      this.means.value = 'pictures';
    }
    this.wantNow();
  }

  private lose(event: Event): void {
    event.preventDefault();
    this.painter?.close();
    this.painter = null;
    this.element.dataset.ready = 'false';
    this.means.value = 'lost';
  }

  private listen(kind: string, handle: (event: Event) => void): void {
    this.element.addEventListener(kind, handle);
    this.ends.push(() => this.element.removeEventListener(kind, handle));
  }

  /** Ready is a promise about the view now asked for. */
  private follow(): void {
    const scene = this.viewer.scene.value;
    const size = this.viewer.canvas.value;
    this.isFinal = !this.viewer.isComing.value;
    this.element.dataset.ready = 'false';
    if (scene && size.width > 0) this.wantNow();
  }

  /** What is missing is asked for before the browser has a frame to draw it in. */
  private wantNow(): void {
    const scene = this.viewer.scene.peek();
    if (scene) this.painter?.want(scene, this.viewer.canvas.peek());
    this.schedule();
  }

  /** Drawing by software takes a core from tiles on their way: until the last one a few pictures a second will do. */
  private takeArrival(): void {
    if (this.painter?.isComplete) {
      this.schedule();
    } else if (this.pause === 0) {
      this.pause = window.setTimeout(() => {
        this.pause = 0;
        this.schedule();
      }, ARRIVALS_MS);
    }
  }

  private schedule(): void {
    cancelAnimationFrame(this.frame);
    this.frame = requestAnimationFrame(() => this.paint());
  }

  private paint(): void {
    const scene = this.viewer.scene.peek();
    const size = this.viewer.canvas.peek();
    if (!this.painter || !scene || size.width === 0) return;
    this.painter.paint(scene, size);
    const {failure} = this.painter;
    this.failure.value = failure === null ? null : asApiError(failure);
    this.element.dataset.ready = String(this.painter.isComplete && failure === null && this.isFinal);
  }
}
