// SPDX-License-Identifier: Apache-2.0
import type {Vector} from '../../gl/scene';
import {Button} from '../../ui/button';
import {isSame, lightAt, lightInWords, placeOf} from './light';
import type {Viewer} from './viewer';

const SIDE_PX = 150;
const RADIUS = 65;

/** Where the light comes from: a disc to drag on, and the places of the rig's LEDs by their numbers. */
export function LightPanel({viewer}: {viewer: Viewer}) {
  const {light, layer} = viewer.sight.value;
  if (layer !== 'relit') return null;
  const leds = viewer.leds.value;
  return (
    <section>
      <h2>Light</h2>
      <div class="row light-row">
        <Disc viewer={viewer} light={light} />
        <div>
          <p>{lightInWords(light)}</p>
          <Button keyHint="l" isPressed={viewer.tool.value === 'light'} onClick={() => toggleLight(viewer)}>Drag on the picture</Button>
        </div>
      </div>
      {leds.length > 0 && (
        <>
          <h3 id="leds">From the place of an LED, as the middle of the table sees it</h3>
          <div class="row" role="group" aria-labelledby="leds">
            {leds.map((each) => (
              <Button key={each.led} isPressed={isSame(each.light, light)} label={`LED ${each.led}`}
                onClick={() => viewer.see({light: each.light}, 'step')}>
                {each.led}
              </Button>
            ))}
          </div>
        </>
      )}
    </section>
  );
}

export function toggleLight(viewer: Viewer): void {
  const isOn = viewer.tool.value === 'light';
  viewer.tool.value = isOn ? 'move' : 'light';
  if (!isOn && viewer.sight.value.layer !== 'relit') viewer.seeLayer('relit');
}

function Disc({viewer, light}: {viewer: Viewer; light: Vector}) {
  const middle = SIDE_PX / 2;
  const at = (vector: Vector) => {
    const place = placeOf(vector);
    return {x: middle + RADIUS * place.x, y: middle + RADIUS * place.y};
  };
  const lamp = at(light);
  const shine = (event: PointerEvent) => {
    const element = event.currentTarget as Element;
    if (event.type === 'pointerdown') element.setPointerCapture(event.pointerId);
    if (!element.hasPointerCapture(event.pointerId)) return;
    const box = element.getBoundingClientRect();
    viewer.shine(lightAt({x: (event.clientX - box.left - middle) / RADIUS, y: (event.clientY - box.top - middle) / RADIUS}));
  };
  return (
    <svg class="disc" width={SIDE_PX} height={SIDE_PX} role="img" aria-label={`The light comes ${lightInWords(light)}`}
      onPointerDown={shine} onPointerMove={shine}>
      <circle class="edge" cx={middle} cy={middle} r={RADIUS} />
      <circle class="half" cx={middle} cy={middle} r={RADIUS * Math.SQRT1_2} />
      {viewer.leds.value.map(({led, light: direction}) => {
        const place = at(direction);
        return <text key={led} x={place.x} y={place.y}>{led}</text>;
      })}
      <line x1={middle} y1={middle} x2={lamp.x} y2={lamp.y} />
      <circle class="lamp" cx={lamp.x} cy={lamp.y} r={7} />
    </svg>
  );
}
