// SPDX-License-Identifier: Apache-2.0
// The picture as a file, with its scale bar and a line that says what it is.
import {scaleBar, zoomInWords} from './bars';
import type {PictureCanvas} from './canvas';
import {hasScale, isDifference, saysOf, unitOf} from './layers';
import {lightInWords} from './light';
import {textOf} from './sight';
import type {Viewer} from './viewer';

const FOOT_PX = 34;

export function captionOf(viewer: Viewer): string {
  const {layer, light, other, divider} = viewer.sight.value;
  const maps = viewer.maps.value;
  const [least, most] = viewer.range.value;
  const how = layer === 'relit' ? ` ${lightInWords(light)}` : '';
  const scale = maps && hasScale(maps.solve, layer) ? ` ${least} to ${most} ${unitOf(maps.solve, layer)}` : '';
  const beside = other && (divider !== null || isDifference(layer)) ? ` against ${other.session}/${other.solve}` : '';
  return `${textOf(viewer.name)}${beside}: ${saysOf(layer)}${how}${scale}`;
}

function drawFoot(context: CanvasRenderingContext2D, viewer: Viewer, width: number, top: number): void {
  const view = viewer.view.value;
  const maps = viewer.maps.value;
  if (!view || !maps) return;
  const bar = scaleBar(maps.solve.mm_per_pixel, view.zoom, width / 5);
  context.fillStyle = '#0b0c0d';
  context.fillRect(0, top, width, FOOT_PX);
  context.fillStyle = '#d3d6d9';
  context.fillRect(10, top + 18, bar.length, 3);
  context.font = '13px system-ui, sans-serif';
  context.textBaseline = 'middle';
  const said = `${bar.says}  ${zoomInWords(view.zoom)}`;
  context.fillText(said, 18 + bar.length, top + 19);
  context.fillText(captionOf(viewer), 34 + bar.length + context.measureText(said).width, top + 19);
}

export async function snapshot(viewer: Viewer, picture: PictureCanvas): Promise<Blob> {
  const seen = picture.drawNow();
  const canvas = document.createElement('canvas');
  canvas.width = seen.width;
  canvas.height = seen.height + FOOT_PX;
  const context = canvas.getContext('2d');
  if (!context) throw new Error('This browser gives no canvas to draw on.');
  context.drawImage(seen, 0, 0);
  drawFoot(context, viewer, seen.width, seen.height);
  return new Promise((resolve, reject) => {
    canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error('The picture could not be packed.'))), 'image/png');
  });
}

/** Hands a file to whoever sits there. */
export function save(blob: Blob, name: string): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  URL.revokeObjectURL(link.href);
}
