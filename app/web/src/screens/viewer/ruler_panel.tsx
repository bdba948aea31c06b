// SPDX-License-Identifier: Apache-2.0
import type {Schemas} from '../../api/client';
import {Axes} from '../../ui/axes';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {linearScale} from '../../ui/plot_scale';
import {measured} from './bars';
import {useAnswer} from './use_answer';
import type {Viewer} from './viewer';

type Profile = Schemas['LineFacts']['profile'];

export function RulerPanel({viewer}: {viewer: Viewer}) {
  const {line} = viewer.sight.value;
  const {answered, complaint} = useAnswer(line, (ends) => viewer.askLine(ends));
  if (!line) return null;
  return (
    <section>
      <div class="row">
        <h2>Ruler</h2>
        <Button kind="quiet" onClick={() => viewer.see({line: null})}>Close</Button>
      </div>
      <Complaint error={complaint} />
      {answered && (
        <>
          <p class="numbers measured">{measured(answered.answer.mm, answered.answer.sigma_mm ?? null)}</p>
          <p class="dim">On the plane of the cloth, by the calibrated camera.</p>
          <Curve profile={answered.answer.profile} values={answered.answer.profile.height_mm} label="height, mm" />
          <p class="dim">Height is summed from slopes along the line. It tells yarns from gaps and drifts over centimetres.</p>
          <Curve profile={answered.answer.profile} values={answered.answer.profile.albedo} label="albedo, green" />
        </>
      )}
    </section>
  );
}

function Curve({profile, values, label}: {profile: Profile; values: number[]; label: string}) {
  const say = (value: number) => String(value);
  const along = linearScale(profile.mm);
  return (
    <Axes title={`Profile of ${label}, along the line in mm`} width={360} height={190} x={{scale: along, label: 'mm', say}}
      y={{scale: linearScale(values, 3), label, say}}>
      {(x, y) => <polyline class="line" points={profile.mm.map((mm, i) => `${x(mm).toFixed(1)},${y(values[i] ?? 0).toFixed(1)}`).join(' ')} />}
    </Axes>
  );
}
