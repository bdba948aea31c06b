// SPDX-License-Identifier: Apache-2.0
// What the maps say in a pixel, and each reading beside what the solve's model makes of it.
import {useState} from 'preact/hooks';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {type PixelFacts, type Reading, reasonOf, type Readings, readingsOf, valuesOf} from './probe';
import {saysOf} from './layers';
import type {Viewer} from './viewer';

/** Shorter than what buttons say: they stand in one line with their values. */
const names: Record<string, string> = {sigma_noise: 'of it noise', sigma_model: 'of it model', sigma_calibration: 'of it calibration'};
const decimals: Record<string, number> = {normal: 4, albedo: 4, residual: 4, height: 3};
const units: Record<string, string> = {sigma: '°', sigma_noise: '°', sigma_model: '°', sigma_calibration: '°', height: ' mm'};

function said(pixel: PixelFacts, layer: string): string {
  const values = valuesOf(pixel, layer);
  if (layer === 'status') return values.join(' ') || 'nothing to say';
  const numbers = values.map((value) => Number(value).toFixed(decimals[layer] ?? 2));
  return numbers.join('  ') + (units[layer] ?? '');
}

export function PixelPanel({viewer}: {viewer: Viewer}) {
  const pixel = viewer.pixel.value;
  const isHeld = viewer.sight.value.pixel !== null;
  return (
    <section class="pixel">
      <div class="row">
        <h2>Pixel {pixel && <span class="numbers" data-testid="pixel-place">{pixel.x}, {pixel.y}</span>}</h2>
        {isHeld && <Button kind="quiet" onClick={() => viewer.hold(null)}>Let go</Button>}
      </div>
      <Complaint error={viewer.pixelComplaint.value} />
      {!pixel && <p class="dim">Point at the picture; a click holds the pixel.</p>}
      {pixel && <PixelTable pixel={pixel} />}
      <AskFor viewer={viewer} />
    </section>
  );
}

/** For who has no pointer. */
function AskFor({viewer}: {viewer: Viewer}) {
  const [typed, setTyped] = useState('');
  const ask = (event: Event) => {
    event.preventDefault();
    const [x, y] = typed.split(/[ ,;]+/).map(Number);
    if (x !== undefined && y !== undefined && Number.isFinite(x) && Number.isFinite(y)) viewer.hold({x, y});
  };
  return (
    <form class="row" onSubmit={ask}>
      <input class="place" aria-label="Column and row of a pixel" placeholder="column, row" inputMode="numeric" value={typed}
        onInput={(event) => setTyped(event.currentTarget.value)} />
      <Button type="submit">Hold</Button>
    </form>
  );
}

function PixelTable({pixel}: {pixel: PixelFacts}) {
  const readings = readingsOf(pixel);
  return (
    <>
      <table class="values">
        <caption class="unseen">What the maps say in pixel {pixel.x}, {pixel.y}</caption>
        <tbody>
          {Object.keys(pixel.maps).map((layer) => (
            <tr key={layer}>
              <th scope="row">{names[layer] ?? saysOf(layer)}</th>
              <td class="numbers">{said(pixel, layer)}</td>
            </tr>
          ))}
          {pixel.table_mm && (
            <tr>
              <th scope="row">On the table</th>
              <td class="numbers">{pixel.table_mm.map((mm) => mm.toFixed(3)).join('  ')} mm</td>
            </tr>
          )}
        </tbody>
      </table>
      {readings ? <ReadingTable readings={readings} pixel={pixel} /> : <NoReadings pixel={pixel} />}
    </>
  );
}

function NoReadings({pixel}: {pixel: PixelFacts}) {
  const isTruth = valuesOf(pixel, 'status').length === 0 && !('status' in pixel.maps);
  return <p class="dim" role="status">{isTruth ? 'The truth has no readings.' : 'The readings of this session are being read.'}</p>;
}

function ReadingTable({readings, pixel}: {readings: Readings; pixel: PixelFacts}) {
  const most = Math.max(...readings.readings.flatMap(({reading, model}) => [reading ?? 0, model ?? 0]), 1e-9);
  return (
    <table class="readings">
      <caption>
        Readings{readings.channel && `, ${readings.channel} photosite`}: bar measured, mark model
        <span class="unseen"> in pixel {pixel.x}, {pixel.y}</span>
      </caption>
      <thead>
        <tr>
          <th scope="col">LED</th>
          <th scope="col">Counts</th>
          <th scope="col">Reading</th>
          <th scope="col">Model</th>
          <th scope="col" class="bars"><span class="unseen">Compared</span></th>
          <th scope="col">σ off</th>
        </tr>
      </thead>
      <tbody>{readings.readings.map((each) => <ReadingRow key={each.led} each={each} most={most} />)}</tbody>
    </table>
  );
}

const number = (value: number | null | undefined, digits: number) => (value == null ? '' : value.toFixed(digits));

function ReadingRow({each, most}: {each: Reading; most: number}) {
  const reason = reasonOf(each);
  return (
    <tr class={each.used ? '' : 'left-out'}>
      <th scope="row">{each.led}</th>
      <td>{each.counts ?? ''}</td>
      <td>{number(each.reading, 3)}</td>
      <td>{number(each.model, 3)}</td>
      <td class="bars"><Bar each={each} most={most} /></td>
      <td>{reason ? <span class="reason">{reason}</span> : number(each.residual_sigma, 1)}</td>
    </tr>
  );
}

function Bar({each, most}: {each: Reading; most: number}) {
  const width = (value: number | null | undefined) => (100 * Math.max(value ?? 0, 0)) / most;
  return (
    <svg viewBox="0 0 104 12" preserveAspectRatio="none" aria-hidden="true">
      <rect class="measured" x="0" y="2" width={width(each.reading)} height="8" />
      {each.model != null && <rect class="model" x={width(each.model)} y="0" width="2" height="12" />}
    </svg>
  );
}
