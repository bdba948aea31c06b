// SPDX-License-Identifier: Apache-2.0
import {Mark} from '../../ui/mark';
import {digits} from '../../ui/say';
import {isMet, shareOf, type Figure} from './photograph_set';

/** How well the camera is known by now, against what is asked. */
export function Figures({figures}: {figures: readonly Figure[]}) {
  return (
    <dl class="figures">
      {figures.map((figure) => (
        <div key={figure.key}>
          <dt>{figure.name}</dt>
          <dd>
            <span class="numbers" data-figure={figure.key}>
              <Mark verdict={isMet(figure) ? 'fine' : 'waiting'}>{digits(figure.now, 3)} {figure.unit}</Mark>
            </span>
            <progress aria-label={`${figure.name} on the way to what is asked`} value={shareOf(figure)} max={1} />
            <span class="dim numbers">
              asked {digits(figure.asked)} {figure.unit}
              {figure.then !== null && `, next ${digits(figure.then)}`}
            </span>
          </dd>
        </div>
      ))}
    </dl>
  );
}
