// SPDX-License-Identifier: Apache-2.0
// Edges of the finder's picture that stand out from its own noise: what is sharp, and where.

/** A colour that cloth seldom has. */
const peak = [255, 64, 200, 255] as const;
/** In the quietest tenth of the picture noise alone makes differences: an edge has so many times as much. */
const quiet = 0.1;
const factor = 8;
const least = 24;

function greensOf({data}: ImageData): Uint8Array {
  return Uint8Array.from({length: data.length / 4}, (_, at) => data[4 * at + 1] ?? 0);
}

/** Sum of both central differences; 0 along the border. */
export function gradientsOf(greens: Uint8Array, width: number, height: number): Uint16Array {
  const gradients = new Uint16Array(greens.length);
  const at = (x: number, y: number) => greens[y * width + x] ?? 0;
  for (let y = 1; y < height - 1; y++) {
    for (let x = 1; x < width - 1; x++) {
      gradients[y * width + x] = Math.abs(at(x + 1, y) - at(x - 1, y)) + Math.abs(at(x, y + 1) - at(x, y - 1));
    }
  }
  return gradients;
}

/** Below which this share of the values is. */
export function quantileOf(values: Uint16Array, share: number): number {
  return values.slice().sort()[Math.floor(values.length * share)] ?? 0;
}

/** A picture that is clear but for the edges. */
export function edgesOf(image: ImageData): ImageData {
  const gradients = gradientsOf(greensOf(image), image.width, image.height);
  const threshold = Math.max(least, factor * quantileOf(gradients, quiet));
  const edges = new ImageData(image.width, image.height);
  gradients.forEach((gradient, at) => {
    if (gradient >= threshold) edges.data.set(peak, 4 * at);
  });
  return edges;
}
