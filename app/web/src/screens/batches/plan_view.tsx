// SPDX-License-Identifier: Apache-2.0
import {Axes} from '../../ui/axes';
import {ClothName} from '../../ui/cloth_name';
import {lanesOf, logScale} from '../../ui/plot_scale';
import {counted, degrees, degreesOn} from '../../ui/say';
import {Table} from '../../ui/table';
import {bytesOf, durationOf} from '../../ui/words';
import {levelPoints, reasonInWords, type Plan} from './plan';

const nameWidth_px = 70;
const lane_px = 15;

/** What a plan costs and gives, and what it leaves out. */
export function PlanView({plan}: {plan: Plan}) {
  const foretold = (text: string) => (plan.sampled > 0 ? text : '–');
  return (
    <>
      <p class="dim">
        {plan.sampled > 0 ? `${degreesOn(plan.mean_deg, plan.solved)} of the cloth predicted` : 'No error foretold'}, {bytesOf(plan.memory_bytes)} of memory, {bytesOf(plan.write_bytes)} written;
        measured on {counted(plan.sampled, 'session')} in {durationOf(plan.sample_seconds)}
      </p>
      <Table caption="Levels" heads={['Level', 'All at it', 'Mean error', 'Spread', 'Planned']}
        rows={plan.levels.map(({quality, seconds, mean_deg, solved, spread_deg, sessions}) => ({
          key: quality, cells: [quality, durationOf(seconds), foretold(degreesOn(mean_deg, solved)), foretold(degrees(spread_deg)), sessions],
        }))} />
      <Curve plan={plan} />
      <Leaf title={counted(plan.jobs.length, 'session')}>
        <Table caption="Sessions" heads={['Session', 'Level', 'Takes', 'Mean error', 'Turns by', 'Known']}
          rows={plan.jobs.map((job) => ({
            key: job.session,
            cells: [
              <a href={`/sessions/${job.session}`}><ClothName session={job.session} /></a>, job.quality, durationOf(job.seconds), foretold(degreesOn(job.degrees, job.solved)),
              job.turn_deg === null ? '' : degrees(job.turn_deg), job.is_measured ? 'measured' : 'carried over',
            ],
          }))} />
      </Leaf>
      {plan.reasons.length > 0 && (
        <Leaf title={plan.reasons.map(({reason, sessions, seconds}) => `${sessions} ${reasonInWords(reason)}${seconds > 0 ? ` (${durationOf(seconds)} saved)` : ''}`).join(', ')}
          isOpen={plan.reasons.some(({reason}) => reason === 'unsolvable')}>
          <Table caption="Left out" heads={['Session', 'Why']}
            rows={plan.left_out_sessions.map(({session, said}) => ({key: session, cells: [<a href={`/sessions/${session}`}><ClothName session={session} /></a>, said]}))} />
        </Leaf>
      )}
    </>
  );
}

function Leaf({title, isOpen, children}: {title: string; isOpen?: boolean; children: preact.ComponentChildren}) {
  return <details open={isOpen}><summary>{title}</summary>{children}</details>;
}

/** Time against the mean error of all: each level, and joined what hours buy. */
function Curve({plan}: {plan: Plan}) {
  const levels = levelPoints(plan);
  const curve = plan.curve.filter(({seconds, mean_deg}) => seconds > 0 && mean_deg > 0);
  const all = [...levels, ...curve];
  if (all.length < 2) return null;
  const x = {scale: logScale(all.map(({seconds}) => seconds)), label: 'seconds on this machine', say: String};
  const y = {scale: logScale(all.map(({mean_deg}) => mean_deg)), label: 'mean error, degrees', say: String};
  return (
    <Axes title="Mean error against time" x={x} y={y} height={240}>
      {(placeX, placeY) => {
        const lanes = lanesOf(levels, ({seconds}) => placeX(seconds), nameWidth_px);
        return <>
          <polyline class="line" points={curve.map((each) => `${placeX(each.seconds)},${placeY(each.mean_deg)}`).join(' ')} />
          {levels.map((level) => {
            const [x_px, y_px] = [placeX(level.seconds), placeY(level.mean_deg)];
            return (
              <g key={level.name}>
                <circle class="point" cx={x_px} cy={y_px} r={4} />
                <text x={x_px} y={y_px - 8 - lane_px * (lanes.get(level) ?? 0)} text-anchor="middle">{level.name}</text>
              </g>
            );
          })}
        </>;
      }}
    </Axes>
  );
}
