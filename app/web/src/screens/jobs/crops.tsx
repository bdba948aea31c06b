// SPDX-License-Identifier: Apache-2.0
// The same pixels as every level makes them, side by side.
import {useState} from 'preact/hooks';
import type {Quality} from '../../state/forms';
import {Button} from '../../ui/button';
import {degreesOn} from '../../ui/say';
import {durationOf} from '../../ui/words';
import type {Level} from './ladder';

interface CropsProps {
  /** The job that found the price: its pictures are asked for by its id. */
  job: string;
  levels: readonly Level[];
  onChoose: (quality: Quality) => void;
}

const looks = [
  {look: 'relit', says: 'Relit'},
  {look: 'normal', says: 'Normals'},
] as const;

export function Crops({job, levels, onChoose}: CropsProps) {
  const [look, setLook] = useState<(typeof looks)[number]['look']>('relit');
  return (
    <section aria-label="The same pixels by every level">
      <div class="row">
        {looks.map((each) => <Button key={each.look} isPressed={look === each.look} onClick={() => setLook(each.look)}>{each.says}</Button>)}
      </div>
      <ul class="crops">
        {levels.map(({quality, predicted_deg, solved, seconds}) => (
          <li key={quality}>
            <button type="button" aria-label={`${quality}, as it looks: queue it`} onClick={() => onChoose(quality)}>
              <span class="crop"><img src={`/api/v1/jobs/${job}/files/${quality}_${look}.png`} alt="" /></span>
              <strong>{quality}</strong> <span class="dim numbers">{degreesOn(predicted_deg, solved)}, {durationOf(seconds)}</span>
            </button>
          </li>
        ))}
      </ul>
    </section>
  );
}
