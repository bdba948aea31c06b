// SPDX-License-Identifier: Apache-2.0
// What the buttons and keys of a viewer do. Ruler and rectangle by keys: arrows lead a point over the map, Enter sets
// the begin and then the end.
import {clamp, nextZoom, panned, type Point, toCanvas, zoomed} from '../../gl/view';
import {useKeys} from '../../state/keys';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {Copy} from '../../ui/copy';
import type {PictureCanvas} from './canvas';
import {Divider, toggleDifference, toggleDivider} from './compare_panel';
import {measure} from './hand';
import {DIFFERENCES, LAYERS} from './layers';
import {nudged} from './light';
import {toggleLight} from './light_panel';
import {addressOfViewer} from './sight';
import {save, snapshot} from './snapshot';
import type {Pencil, Tool, Viewer} from './viewer';

/** How far an arrow goes: a share of the canvas, or of the disc of lights. */
const ARROW_SHARE = 1 / 8;
const ARROW_LIGHT = 0.08;
/** Steps of the end of a ruler with Shift. */
const FAST = 20;

const arrows = [
  {key: 'ArrowLeft', does: 'to the left', by: {x: -1, y: 0}},
  {key: 'ArrowRight', does: 'to the right', by: {x: 1, y: 0}},
  {key: 'ArrowUp', does: 'up', by: {x: 0, y: -1}},
  {key: 'ArrowDown', does: 'down', by: {x: 0, y: 1}},
];

function zoomBy(viewer: Viewer, direction: 1 | -1): void {
  viewer.move((view, canvas) => {
    const middle = {x: canvas.width / 2, y: canvas.height / 2};
    return zoomed(view, nextZoom(view.zoom, direction) / view.zoom, middle, canvas);
  });
}

function zoomTo(viewer: Viewer, zoom: number): void {
  viewer.move((view) => ({...view, zoom}));
}

function isMeasuring(viewer: Viewer): boolean {
  return viewer.tool.value === 'ruler' || viewer.tool.value === 'region';
}

/** At first in the middle of a pixel in the middle of the view. */
function pencilOf(viewer: Viewer): Pencil {
  const {x, y} = viewer.view.value ?? {x: 0, y: 0};
  return viewer.pencil.value ?? {at: {x: Math.floor(x) + 0.5, y: Math.floor(y) + 0.5}, begin: null};
}

/** A step is a pixel of the map, or of the canvas where that is farther: a smaller one would not be seen. */
function lead(viewer: Viewer, by: Point): void {
  const map = viewer.maps.value?.solve;
  const view = viewer.view.value;
  if (!map || !view) return;
  const step = Math.max(1, 1 / view.zoom);
  const {at, begin} = pencilOf(viewer);
  const to = {x: clamp(at.x + step * by.x, 0, map.width), y: clamp(at.y + step * by.y, 0, map.height)};
  viewer.pencil.value = {at: to, begin};
  const canvas = viewer.canvas.value;
  const seen = toCanvas(to, view, canvas);
  const isSeen = seen.x >= 0 && seen.y >= 0 && seen.x <= canvas.width && seen.y <= canvas.height;
  if (!isSeen) viewer.move(({zoom}) => ({...to, zoom}));
  if (begin) measure(viewer, begin, to);
}

function setEnd(viewer: Viewer): void {
  const {at, begin} = pencilOf(viewer);
  viewer.pencil.value = {at, begin: begin ? null : at};
  if (!begin) measure(viewer, at, at);
}

/** Takes a tool that measures, for the hand and for keys, or puts it away. */
function toggleTool(viewer: Viewer, tool: Tool): void {
  const isOn = viewer.tool.value === tool;
  viewer.pencil.value = null;
  if (!isOn) document.querySelector<HTMLElement>('.picture canvas')?.focus();
  viewer.tool.value = isOn ? 'move' : tool;
  if (!isOn) viewer.see({panel: 'measure'});
}

/** Arrows move the view, or the light while it is held, or an end of what is measured. */
function arrow(viewer: Viewer, by: Point, times: number): void {
  if (isMeasuring(viewer)) {
    lead(viewer, {x: times * by.x, y: times * by.y});
    return;
  }
  if (viewer.tool.value === 'light') {
    viewer.shine(nudged(viewer.sight.value.light, {x: by.x * ARROW_LIGHT, y: by.y * ARROW_LIGHT}));
    return;
  }
  viewer.move((view, canvas) => panned(view, {x: -by.x * canvas.width * ARROW_SHARE, y: -by.y * canvas.height * ARROW_SHARE}));
}

function tile(viewer: Viewer, count: 2 | 3): void {
  viewer.see({repeat: viewer.sight.value.repeat === count ? 1 : count}, 'step');
}

interface Neighbours {
  previous: () => void;
  next: () => void;
}

export function useViewerKeys(viewer: Viewer, {previous, next}: Neighbours): void {
  useKeys('viewer', [
    ...LAYERS.map(({name, says, key}) => ({key, does: says, run: () => viewer.seeLayer(name)})),
    ...DIFFERENCES.map(({name, says, key}) => ({key, does: `${says} to the other`, run: () => toggleDifference(viewer, name)})),
    {key: 'b', does: 'divider', run: () => toggleDivider(viewer)},
    {key: 'l', does: 'light by drag', run: () => toggleLight(viewer)},
    {key: 'r', does: 'ruler', run: () => toggleTool(viewer, 'ruler')},
    {key: 's', does: 'figures of a rectangle', run: () => toggleTool(viewer, 'region')},
    {key: 't', does: '3 x 3 tiles', run: () => tile(viewer, 3)},
    {key: '+', does: 'nearer', run: () => zoomBy(viewer, 1)},
    {key: '-', does: 'farther', run: () => zoomBy(viewer, -1)},
    {key: '0', does: 'all of it', run: () => viewer.see({view: null})},
    ...arrows.flatMap(({key, does, by}) => [
      {key, does, run: () => arrow(viewer, by, 1)},
      {key: `Shift+${key}`, does: `${does}, ruler and rectangle farther`, run: () => arrow(viewer, by, FAST)},
    ]),
    {key: 'Enter', does: 'sets an end of ruler or rectangle', run: () => isMeasuring(viewer) && setEnd(viewer)},
    {key: '[', does: 'previous session', run: previous},
    {key: ']', does: 'next session', run: next},
  ]);
}

export function Toolbar({viewer, picture}: {viewer: Viewer; picture: PictureCanvas | null}) {
  const tool = viewer.tool.value;
  const {divider, repeat, seam} = viewer.sight.value;
  const take = useAction(async () => {
    if (picture) save(await snapshot(viewer, picture), `${viewer.name.session}-${viewer.sight.value.layer}.png`);
  });
  return (
    <div class="toolbar" role="toolbar" aria-label="Tools">
      <div class="row">
        <Button keyHint="l" isPressed={tool === 'light'} onClick={() => toggleLight(viewer)}>Light</Button>
        <Button keyHint="r" isPressed={tool === 'ruler'} onClick={() => toggleTool(viewer, 'ruler')}>Ruler</Button>
        <Button keyHint="s" isPressed={tool === 'region'} onClick={() => toggleTool(viewer, 'region')}>Rectangle</Button>
      </div>
      <div class="row">
        <Button kind="quiet" label="Farther" onClick={() => zoomBy(viewer, -1)}>−</Button>
        <Button kind="quiet" onClick={() => viewer.see({view: null})}>All</Button>
        <Button kind="quiet" onClick={() => zoomTo(viewer, 1)}>1:1</Button>
        <Button kind="quiet" label="Nearer" onClick={() => zoomBy(viewer, 1)}>+</Button>
        <Button kind="quiet" isPressed={repeat === 2} onClick={() => tile(viewer, 2)}>2 × 2</Button>
        <Button kind="quiet" keyHint="t" isPressed={repeat === 3} onClick={() => tile(viewer, 3)}>3 × 3</Button>
        {repeat > 1 && <Button kind="quiet" isPressed={seam} onClick={() => viewer.see({seam: !seam}, 'step')}>Seam</Button>}
      </div>
      {viewer.before.value && (
        <div class="row">
          <Button keyHint="b" isPressed={divider !== null} onClick={() => toggleDivider(viewer)}>Before</Button>
          <Divider viewer={viewer} says="Before, after" />
        </div>
      )}
      <div class="row">
        <Button kind="quiet" isDisabled={!picture || take.isBusy} onClick={() => void take.run()}>Snapshot</Button>
        <Copy text={location.origin + addressOfViewer(viewer.name, viewer.sight.value)} what="Copy address" />
      </div>
      <Complaint error={take.complaint} />
    </div>
  );
}
