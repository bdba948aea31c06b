// SPDX-License-Identifier: Apache-2.0
// A material that is looked at: what the daemon says of it, and how it is seen.
import {computed, signal} from '@preact/signals';
import {type ApiError, asApiError, fetched, type Schemas} from '../../api/client';
import type {ClothLook, ClothMaps} from '../../gl/cloth_surface';
import type {Size} from '../../gl/view';
import {amend, place} from '../../state/address';
import {fieldsOf} from '../../ui/fields';
import {addressOfMaterial, type MaterialName, type MaterialSight, queryOf, sightOf} from './material_sight';
import {layersOf, parametersOf, shadedBy} from './parameters';
import {pxPerMm} from './screen_scale';
import {type ClothExtent, laidOut} from './shape';

const WRITE_MS = 250;

export class Look {
  readonly viewed = signal<Schemas['ViewedSolve'] | null>(null);
  readonly complaint = signal<ApiError | null>(null);
  readonly sight = signal<MaterialSight>(sightOf(place.peek().query));
  /** Pixels of the page. */
  readonly canvas = signal<Size>({width: 0, height: 0});
  /** A hand moves the light: half the resolution will do. */
  readonly isMoving = signal(false);
  private timer = 0;

  readonly document = computed(() => this.viewed.value?.set);
  readonly parameters = computed(() => parametersOf(this.document.value, this.viewed.value?.layers));

  readonly cloth = computed<ClothExtent | null>(() => {
    const viewed = this.viewed.value;
    if (!viewed) return null;
    const mm = viewed.mm_per_pixel ?? 1;
    return {size_mm: [viewed.width * mm, viewed.height * mm], is_known: viewed.mm_per_pixel != null, repeats: fieldsOf(viewed.set)['is_tile'] === true};
  });

  readonly maps = computed<ClothMaps | null>(() => {
    const viewed = this.viewed.value;
    if (!viewed) return null;
    const {width, height, tile, levels} = viewed;
    return {
      maps: addressOfMaterial(this.name), pyramid: {size: {width, height}, side: tile, levels},
      layers: layersOf(viewed.layers), repeats: this.cloth.value?.repeats === true,
    };
  });

  readonly laid = computed(() => {
    const cloth = this.cloth.value;
    const canvas = this.canvas.value;
    return cloth && canvas.width > 0 ? laidOut(cloth, this.sight.value, canvas, pxPerMm()) : null;
  });

  constructor(readonly name: MaterialName) {
    fetched(addressOfMaterial(name)).then(
      async (response) => (this.viewed.value = (await response.json()) as Schemas['ViewedSolve']),
      (error: unknown) => (this.complaint.value = asApiError(error)),
    );
  }

  see(changes: Partial<MaterialSight>): void {
    this.sight.value = {...this.sight.peek(), ...changes};
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => amend(queryOf(this.sight.peek())), WRITE_MS);
  }

  close(): void {
    clearTimeout(this.timer);
  }

  /** What is drawn on a canvas with so many pixels for each of the page. */
  drawn(density: number): ClothLook | null {
    const [viewed, maps, cloth, laid] = [this.viewed.value, this.maps.value, this.cloth.value, this.laid.value];
    if (!viewed || !maps || !cloth || !laid) return null;
    const {light, exposure, surroundings, typed} = this.sight.value;
    const {width, height} = this.canvas.value;
    return {
      canvas: {width: Math.round(width * density), height: Math.round(height * density)},
      px_per_mm: laid.px_per_mm * density, cloth_mm: cloth.size_mm, cells: laid.cells, radius_mm: laid.radius_mm,
      slant_deg: laid.slant_deg, light, gain: viewed.display_gain, exposure, surroundings,
      ...shadedBy(this.parameters.value, maps.layers, typed), step: this.isMoving.value ? 2 : 1,
    };
  }
}
