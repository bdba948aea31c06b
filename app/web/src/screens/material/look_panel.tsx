// SPDX-License-Identifier: Apache-2.0
// How the material is seen, and what it is made of.
import {useState} from 'preact/hooks';
import {Button} from '../../ui/button';
import {Mark} from '../../ui/mark';
import {lengthInWords} from '../viewer/bars';
import type {Look} from './look';
import {BALLS_MM, MOST_LEAN_DEG, REPEATS, type Shape} from './material_sight';
import type {Parameter} from './parameters';
import {BROWSER_PX_PER_MM, CARD_MM, keep, measured, pxPerMm} from './screen_scale';
import {Slider} from './slider';

const shapes: readonly {shape: Shape; says: string; key: string}[] = [
  {shape: 'ball', says: 'Ball', key: 'b'},
  {shape: 'plane', says: 'Plane', key: 'p'},
  {shape: 'true', says: 'True size', key: 't'},
];

export function LookPanel({look}: {look: Look}) {
  return <><ShapeSection look={look} /><LightSection look={look} /><Parameters look={look} /></>;
}

function ShapeSection({look}: {look: Look}) {
  const {shape, repeat, ball_mm, lean_deg} = look.sight.value;
  const cloth = look.cloth.value;
  return (
    <section>
      <h2>Shape</h2>
      <div class="row" role="group" aria-label="Shape">
        {shapes.map((each) => (
          <Button key={each.shape} keyHint={each.key} isPressed={shape === each.shape} isDisabled={each.shape === 'true' && cloth?.is_known === false} onClick={() => look.see({shape: each.shape})}>{each.says}</Button>
        ))}
      </div>
      {cloth?.is_known && <p class="dim numbers">{cloth.size_mm.map(lengthInWords).join(' × ')}{cloth.repeats ? ', repeats' : ''}</p>}
      {shape === 'ball' && cloth?.repeats && cloth.is_known && (
        <div class="row" role="group" aria-label="Ball">
          {BALLS_MM.map((mm) => <Button key={mm} isPressed={ball_mm === mm} onClick={() => look.see({ball_mm: mm})}>{mm} mm</Button>)}
        </div>
      )}
      {shape === 'plane' && cloth?.repeats && (
        <div class="row" role="group" aria-label="Repeats">
          {REPEATS.map((count) => <Button key={count} isPressed={repeat === count} onClick={() => look.see({repeat: count})}>{count} × {count}</Button>)}
        </div>
      )}
      {shape === 'plane' && <Slider label="Leaning back" value={lean_deg} ends={[0, MOST_LEAN_DEG]} says={`${Math.round(lean_deg)}°`} onChange={(deg) => look.see({lean_deg: deg})} />}
      {cloth && !cloth.repeats && <p class="dim">One piece: its borders do not fit. <b>tile</b> under Finish makes maps that repeat.</p>}
      {shape === 'true' && cloth?.is_known && <ScreenCheck />}
    </section>
  );
}

/** Once for each screen: a card held to an outline of its size. */
function ScreenCheck() {
  const [isOpen, open] = useState(false);
  const scale = pxPerMm();
  const isKnown = measured.value !== null;
  return (
    <>
      <p><Mark verdict={isKnown ? 'fine' : 'warning'}>{isKnown ? 'this screen was measured' : 'this screen is taken for one of 96 pixels an inch'}</Mark></p>
      <div class="row">
        <Button onClick={() => open(!isOpen)} isPressed={isOpen}>Hold a card to it</Button>
        {isKnown && <Button kind="quiet" onClick={() => keep(null)}>Forget it</Button>}
      </div>
      {isOpen && (
        <>
          <p class="dim">Lay a bank card on the outline and draw it to the card's size: {CARD_MM.join(' × ')} mm.</p>
          <div class="card" style={{width: `${CARD_MM[0] * scale}px`, height: `${CARD_MM[1] * scale}px`}} />
          <Slider label="Size of the outline" value={scale} ends={[BROWSER_PX_PER_MM / 2, BROWSER_PX_PER_MM * 2]} says={`${scale.toFixed(2)} px/mm`} onChange={keep} />
          {!isKnown && <Button onClick={() => keep(scale)}>It fits</Button>}
        </>
      )}
    </>
  );
}

function LightSection({look}: {look: Look}) {
  const {exposure, surroundings} = look.sight.value;
  return (
    <section>
      <h2>Light</h2>
      <p class="dim">Drag the lamp over the picture.</p>
      <Slider label="Exposure" value={exposure} ends={[-4, 6]} says={`${exposure.toFixed(1)} stops`} onChange={(stops) => look.see({exposure: stops})} />
      <Slider label="Surroundings" value={surroundings} ends={[0, 1]} onChange={(share) => look.see({surroundings: share})} />
    </section>
  );
}

function Parameters({look}: {look: Look}) {
  const {typed} = look.sight.value;
  const relative = look.viewed.value?.albedo_scale === 'relative';
  return (
    <section>
      <h2>Made of</h2>
      <ul class="parameters" aria-label="Parameters">
        {look.parameters.value.map((each) => (
          <li key={each.name} data-name={each.name}>
            <div class="row"><span class="says">{each.says}</span><SourceMark parameter={each} /></div>
            <Value look={look} parameter={each} value={typed[each.name] ?? each.value} />
            {each.name === 'albedo' && relative && <p class="warning">▲ without an absolute scale: shown as bright as it can be</p>}
          </li>
        ))}
      </ul>
    </section>
  );
}

function SourceMark({parameter: {source}}: {parameter: Parameter}) {
  return <Mark verdict={source === 'assumed' ? 'warning' : source === 'measured' ? 'fine' : 'waiting'}>{source}</Mark>;
}

function Value({look, parameter: {name, says, ends, isMap, unit, why}, value}: {look: Look; parameter: Parameter; value: number | null}) {
  const number = value === null ? '' : `${Number(value.toPrecision(3))} ${unit === 'share' ? '' : unit}`;
  // The mean of a normal or a height is 0, and says nothing.
  const words = !isMap ? number : value === null || name === 'normal' || name === 'height' ? 'map' : `map, mean ${number}`;
  return (
    <>
      {ends && value !== null
        ? <Slider label={says} value={value} ends={ends} isAssumed onChange={(to) => look.see({typed: {...look.sight.peek().typed, [name]: to}})} />
        : <span class="dim numbers">{words}</span>}
      {why && <span class="dim">{why}</span>}
    </>
  );
}
