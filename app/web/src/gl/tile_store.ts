// SPDX-License-Identifier: Apache-2.0
// Tiles by their address: asked for a few at once, the most wanted first, and kept as long as the budget allows.

/** How a tile is got, and what it costs to hold. */
export interface TileSource<T> {
  load(address: string, signal: AbortSignal): Promise<T>;
  bytes(tile: T): number;
  free(tile: T): void;
}

export interface TileStoreOptions {
  budget_bytes: number;
  at_once: number;
}

export const DEFAULT_OPTIONS: TileStoreOptions = {budget_bytes: 256e6, at_once: 4};

export class TileStore<T> {
  private readonly tiles = new Map<string, T>();
  private readonly loading = new Map<string, AbortController>();
  private readonly failed = new Map<string, unknown>();
  private wanted: string[] = [];
  private bytes = 0;

  constructor(
    private readonly source: TileSource<T>,
    private readonly changed: () => void,
    private readonly options: TileStoreOptions = DEFAULT_OPTIONS,
  ) {}

  /** A tile that is there. Those asked for last are the last to go. */
  get(address: string): T | undefined {
    const tile = this.tiles.get(address);
    if (tile === undefined) return undefined;
    this.tiles.delete(address);
    this.tiles.set(address, tile);
    return tile;
  }

  /** All that the view needs, the most wanted first. What is on its way and no longer needed is given up. */
  want(addresses: string[]): void {
    this.wanted = addresses;
    const needed = new Set(addresses);
    for (const [address, request] of this.loading) {
      if (!needed.has(address)) request.abort();
    }
    this.askForMore();
  }

  /** Nothing that is wanted is missing, but for what failed. */
  get isComplete(): boolean {
    return this.wanted.every((address) => this.tiles.has(address) || this.failed.has(address));
  }

  /** Why a wanted tile could not be had; null where all could. */
  get failure(): unknown {
    const address = this.wanted.find((each) => this.failed.has(each));
    return address === undefined ? null : this.failed.get(address);
  }

  /** Asks again for what could not be had. */
  retry(): void {
    this.failed.clear();
    this.askForMore();
  }

  close(): void {
    this.want([]);
    for (const tile of this.tiles.values()) this.source.free(tile);
    this.tiles.clear();
    this.bytes = 0;
  }

  private askForMore(): void {
    for (const address of this.wanted) {
      if (this.loading.size >= this.options.at_once) return;
      if (!this.tiles.has(address) && !this.loading.has(address) && !this.failed.has(address)) void this.ask(address);
    }
  }

  private async ask(address: string): Promise<void> {
    const request = new AbortController();
    this.loading.set(address, request);
    try {
      const tile = await this.source.load(address, request.signal);
      if (request.signal.aborted) this.source.free(tile);
      else this.keep(address, tile);
    } catch (error) {
      if (!request.signal.aborted) this.failed.set(address, error);
    }
    this.loading.delete(address);
    this.askForMore();
    if (!request.signal.aborted) this.changed();
  }

  private keep(address: string, tile: T): void {
    this.tiles.set(address, tile);
    this.bytes += this.source.bytes(tile);
    const needed = new Set(this.wanted);
    for (const [old, unused] of this.tiles) {
      if (this.bytes <= this.options.budget_bytes) return;
      if (needed.has(old)) continue;
      this.tiles.delete(old);
      this.bytes -= this.source.bytes(unused);
      this.source.free(unused);
    }
  }
}
