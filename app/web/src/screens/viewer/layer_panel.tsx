// SPDX-License-Identifier: Apache-2.0
// How the layer is shown: exposure, scale of colours, bits of status.
import {useState} from 'preact/hooks';
import {Button} from '../../ui/button';
import {Choice} from '../../ui/choice';
import {percentOf} from '../../ui/words';
import {
  bitColour, bitMeaning, bitsOf, choicesOf, explanationOf, FULL_SCALES, hasExposure, hasScale, isThere, SIGMA_PARTS, unitOf,
} from './layers';
import {cssColour} from './legend';
import {sharesOf} from './probe';
import type {Viewer} from './viewer';

export function LayerPanel({viewer}: {viewer: Viewer}) {
  const maps = viewer.maps.value;
  if (!maps) return null;
  const {layer} = viewer.sight.value;
  const family = layer.startsWith('sigma') ? 'sigma' : layer;
  const parts = SIGMA_PARTS.filter(({name}) => isThere(maps.solve, name));
  return (
    <section>
      <h2>Layer</h2>
      <div class="layers" role="group" aria-label="Layers">
        {choicesOf(maps.solve).map(({name, says, key}) => (
          <Button key={name} keyHint={key || undefined} isPressed={family === name}
            onClick={() => viewer.seeLayer(name)}>
            {says}
          </Button>
        ))}
      </div>
      <p class="dim">{explanationOf(layer)}</p>
      {family === 'sigma' && parts.length > 1 && (
        <Choice label="Part of sigma" value={layer} options={parts.map(({name, says}) => ({value: name, says}))}
          onChange={(name) => viewer.seeLayer(name)} />
      )}
      {hasExposure(layer) && <Exposure viewer={viewer} />}
      {hasScale(maps.solve, layer) && <ScaleOfColours viewer={viewer} unit={unitOf(maps.solve, layer)} />}
      {bitsOf(maps.solve).length > 0 && <Bits viewer={viewer} bits={bitsOf(maps.solve)} />}
    </section>
  );
}

function Exposure({viewer}: {viewer: Viewer}) {
  const {exposure} = viewer.sight.value;
  const set = (stops: number) => viewer.see({exposure: stops});
  return (
    <div class="field">
      <label for="exposure">Exposure, {exposure > 0 ? '+' : ''}{exposure.toFixed(1)} stops</label>
      <div class="row">
        <input id="exposure" type="range" min={-4} max={6} step={0.1} value={exposure}
          onInput={(event) => set(event.currentTarget.valueAsNumber)} />
        <Button kind="quiet" isDisabled={exposure === 0} onClick={() => set(0)}>0</Button>
      </div>
    </div>
  );
}

function ScaleOfColours({viewer, unit}: {viewer: Viewer; unit: string}) {
  const [least, most] = viewer.range.value;
  const set = (ends: [number, number]) => {
    if (ends[1] > ends[0]) viewer.see({range: ends}, 'step');
  };
  return (
    <div class="field">
      <span class="name">Scale, {unit}</span>
      <div class="row">
        <End label="From" value={least} onChange={(value) => set([value, most])} />
        <End label="To" value={most} onChange={(value) => set([least, value])} />
        <Button kind="quiet" isDisabled={!viewer.sight.value.range} onClick={() => viewer.see({range: null}, 'step')}>As the map asks</Button>
      </div>
      <div class="row" role="group" aria-label="Full scale">
        {FULL_SCALES.map((full) => (
          <Button key={full} isPressed={least === 0 && most === full} onClick={() => set([0, full])}>{full}</Button>
        ))}
      </div>
    </div>
  );
}

/** A number that holds once it is typed to its end. */
function End({label, value, onChange}: {label: string; value: number; onChange: (value: number) => void}) {
  const [typed, setTyped] = useState<string | null>(null);
  const finish = () => {
    const number = Number(typed);
    if (typed !== null && typed.trim() !== '' && Number.isFinite(number)) onChange(number);
    setTyped(null);
  };
  return (
    <input class="end" aria-label={label} inputMode="decimal" value={typed ?? String(Number(value.toPrecision(4)))}
      onInput={(event) => setTyped(event.currentTarget.value)} onBlur={finish}
      onKeyDown={(event) => event.key === 'Enter' && finish()} />
  );
}

function Bits({viewer, bits}: {viewer: Viewer; bits: readonly string[]}) {
  const shown = viewer.bits.value;
  const shares = viewer.whole.value && sharesOf(viewer.whole.value);
  const isStatus = viewer.sight.value.layer === 'status';
  const toggle = (bit: string) => {
    const others = shown.filter((each) => each !== bit);
    viewer.see({bits: shown.includes(bit) ? others : bits.filter((each) => each === bit || others.includes(each))}, 'step');
  };
  return (
    <details class="bits" open={isStatus}>
      <summary>Status {isStatus ? 'by name' : 'over the picture'}</summary>
      {bits.map((bit) => (
        <label key={bit} class="bit" title={bitMeaning(bit)}>
          <input type="checkbox" checked={shown.includes(bit)} onChange={() => toggle(bit)} />
          <span class="swatch" style={{background: cssColour(bitColour(bit))}} />
          <span class="name">{bit}<small class="dim">{bitMeaning(bit)}</small></span>
          <span class="numbers">{shares ? percentOf(shares[bit] ?? 0) : ''}</span>
        </label>
      ))}
    </details>
  );
}
