// SPDX-License-Identifier: Apache-2.0
import {useSignalEffect} from '@preact/signals';
import {useRef} from 'preact/hooks';
import type {Schemas} from '../../api/client';
import {Complaint} from '../../ui/complaint';
import {framing, picture, trouble} from './devices';
import {edgesOf} from './peaking';
import {showsEdges, showsGrid, turn} from './preferences';

/** Draws the finder's picture, with its edges where they are asked for. */
function draw(canvas: HTMLCanvasElement, frame: ImageBitmap): void {
  canvas.width = frame.width;
  canvas.height = frame.height;
  const context = canvas.getContext('2d', {willReadFrequently: showsEdges.value});
  if (!context) return;
  context.drawImage(frame, 0, 0);
  if (!showsEdges.value) return;
  const edges = edgesOf(context.getImageData(0, 0, frame.width, frame.height));
  void createImageBitmap(edges).then((drawn) => context.drawImage(drawn, 0, 0));
}

function Grid() {
  const thirds = [1 / 3, 2 / 3];
  return (
    <g class="grid">
      {thirds.map((at) => <line key={`x${at}`} x1={at} y1={0} x2={at} y2={1} />)}
      {thirds.map((at) => <line key={`y${at}`} x1={0} y1={at} x2={1} y2={at} />)}
      <line x1={0.5} y1={0.45} x2={0.5} y2={0.55} />
      <line x1={0.47} y1={0.5} x2={0.53} y2={0.5} />
    </g>
  );
}

function Shape({shape, kind}: {shape: Schemas['FramedShape']; kind: string}) {
  return <polygon class={kind} points={shape.corners.map((corner) => corner.join(',')).join(' ')} />;
}

/** As wide and as high as its place allows, in the shape of the picture. */
export function aspectOf(shown: {width: number; height: number} | null): string | undefined {
  return shown ? `--aspect: ${shown.width / shown.height}` : undefined;
}

interface FinderProps {
  /** Where the calibration has the table's tags. */
  belongs: readonly Schemas['FramedShape'][];
}

/** What the camera's finder shows, for framing: the camera chooses its exposure. */
export function Finder({belongs}: FinderProps) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useSignalEffect(() => {
    if (canvas.current && picture.value) draw(canvas.current, picture.value);
  });
  return (
    <figure class="finder sheet" style={aspectOf(picture.value)}>
      <div style={{rotate: `${turn.value}deg`}}>
        <canvas ref={canvas} role="img" aria-label="Live view" hidden={!picture.value} />
        <svg viewBox="0 0 1 1" preserveAspectRatio="none" aria-hidden="true">
          {showsGrid.value && <Grid />}
          {belongs.map((shape) => <Shape key={shape.name} shape={shape} kind="belongs" />)}
          {framing.value?.tags.map((shape) => <Shape key={shape.name} shape={shape} kind="tag" />)}
          {framing.value?.board && <Shape shape={framing.value.board} kind="board" />}
        </svg>
      </div>
      {trouble.value ? <Complaint error={trouble.value} /> : !picture.value && <p class="waits">Waiting for the first picture</p>}
      <figcaption>Framing only: the camera chooses its exposure. {tagsInWords(belongs.length)}</figcaption>
    </figure>
  );
}

function tagsInWords(known: number): string {
  const seen = framing.value;
  if (!seen) return '';
  const tags = known > 0 ? `${seen.fiducials} of ${known} tags in sight` : `${seen.tags.length} tags in sight`;
  return seen.off_mm === null ? `${tags}.` : `${tags}, ${seen.off_mm.toFixed(1)} mm from where they belong.`;
}
