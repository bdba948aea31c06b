// SPDX-License-Identifier: Apache-2.0
import type {Scene} from './scene';
import type {TileStore} from './tile_store';
import type {Size} from './view';

/** Something that shows scenes, of tiles. */
export abstract class Painter {
  protected abstract readonly store: TileStore<unknown>;

  /** Asks for what is missing of a scene. */
  abstract want(scene: Scene, canvas: Size): void;

  /** Draws what is there of a scene that was wanted. */
  abstract paint(scene: Scene, canvas: Size): void;

  /** All of the last scene is there. */
  get isComplete(): boolean {
    return this.store.isComplete;
  }

  /** Why something of it could not be had. */
  get failure(): unknown {
    return this.store.failure;
  }

  retry(): void {
    this.store.retry();
  }

  close(): void {
    this.store.close();
  }
}
