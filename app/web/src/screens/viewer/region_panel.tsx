// SPDX-License-Identifier: Apache-2.0
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {percentOf} from '../../ui/words';
import {saysOf, unitOf} from './layers';
import {type ChannelFacts, channelsOf, type RegionFacts, sharesOf} from './probe';
import {useAnswer} from './use_answer';
import type {Viewer} from './viewer';

/** Layers whose figures belong to what is seen. */
function layersOf(layer: string): string[] {
  if (layer === 'relit') return ['normal', 'albedo'];
  if (layer === 'albedo_difference') return ['albedo'];
  return layer === 'difference' ? ['normal'] : [layer];
}

export function RegionPanel({viewer}: {viewer: Viewer}) {
  const {box, layer} = viewer.sight.value;
  const {answered, complaint} = useAnswer(box, (each) => viewer.askRegion(each));
  if (!box) return null;
  return (
    <section class="region">
      <div class="row">
        <h2>Rectangle</h2>
        <Button kind="quiet" onClick={() => viewer.see({box: null})}>Close</Button>
      </div>
      <Complaint error={complaint} />
      {answered && (
        <>
          <p class="numbers">
            {answered.question.width} × {answered.question.height} pixels from {answered.question.x}, {answered.question.y}
            {answered.answer.level > 0 && `, counted as means of ${4 ** answered.answer.level} pixels`}
          </p>
          {layersOf(layer).map((name) => <LayerFigures key={name} viewer={viewer} facts={answered.answer} layer={name} />)}
          <Shares facts={answered.answer} />
        </>
      )}
    </section>
  );
}

function LayerFigures({viewer, facts, layer}: {viewer: Viewer; facts: RegionFacts; layer: string}) {
  const channels = Object.entries(channelsOf(facts, layer)).flatMap(([name, each]) => (each ? [{name, each}] : []));
  const maps = viewer.maps.value;
  if (!maps || channels.length === 0) return null;
  const digits = (value: number) => value.toFixed(4);
  return (
    <>
      <table>
        <caption>{saysOf(layer)} {unitOf(maps.solve, layer)}</caption>
        <thead>
          <tr>
            <th scope="col">Channel</th><th scope="col">Mean</th><th scope="col">Deviation</th>
            <th scope="col">5 %</th><th scope="col">Median</th><th scope="col">95 %</th>
          </tr>
        </thead>
        <tbody>
          {channels.map(({name, each}) => (
            <tr key={name}>
              <th scope="row">{name}</th>
              {[each.mean, each.deviation, each.p5, each.p50, each.p95].map((value, i) => <td key={i}>{digits(value)}</td>)}
            </tr>
          ))}
        </tbody>
      </table>
      {channels.map(({name, each}) => <Histogram key={name} name={name} facts={each} />)}
    </>
  );
}

/** 64 columns from the least to the most value; the highest fills the height. */
function Histogram({name, facts}: {name: string; facts: ChannelFacts}) {
  const highest = Math.max(...facts.bins, 1);
  const most = Math.round((100 * highest) / Math.max(1, facts.bins.reduce((sum, count) => sum + count, 0)));
  return (
    <figure class="histogram">
      <figcaption>{name}: pixels by value, the highest column is {most} %</figcaption>
      <svg viewBox="0 0 64 30" preserveAspectRatio="none" role="img" aria-label={`Histogram of ${name} from ${facts.least} to ${facts.most}`}>
        {facts.bins.map((count, i) => {
          const height = (30 * count) / highest;
          return <rect key={i} x={i} y={30 - height} width="1" height={height} />;
        })}
      </svg>
      <div class="ends numbers"><span>{facts.least.toFixed(3)}</span><span>{facts.most.toFixed(3)}</span></div>
    </figure>
  );
}

function Shares({facts}: {facts: RegionFacts}) {
  const occurring = Object.entries(sharesOf(facts)).filter(([, share]) => share > 0);
  if (occurring.length === 0) return null;
  return <p class="dim">{occurring.map(([bit, share]) => `${bit} ${percentOf(share)}`).join(', ')}</p>;
}
