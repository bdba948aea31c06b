// SPDX-License-Identifier: Apache-2.0
// What came of the last scan: its photographs, each with its verdict, and the cloth under another light.
import {useState} from 'preact/hooks';
import {rig} from '../../state/rig';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {Mark} from '../../ui/mark';
import {digits} from '../../ui/say';
import {useLatest} from '../../ui/use_latest';
import {VerdictLine} from '../../ui/verdict';
import {percentOf} from '../../ui/words';
import {useJobs} from '../jobs/jobs';
import {Price} from '../jobs/price';
import {exposedOf, lessThan, type Exposed} from './clipping';
import {followSolve, relitPicture, shootAgain, type Session} from './scan';

type Frame = Session['frames'][number];

function titleOf({role, led}: Frame): string {
  const lit = `LED ${led}`;
  return {lit, dark: 'dark', repeat: led === 0 ? 'dark at the end' : `${lit} again`, bracket: `${lit} bracket`, below: 'from below', blade: `${lit} with a blade`}[role];
}

interface AgainProps {
  session: Session;
  frame: Frame;
  exposed: Exposed | null;
}

/** One photograph once more, by less light where it is over. */
function Again({session, frame, exposed}: AgainProps) {
  const exposure_us = exposed?.word === 'over' ? lessThan(frame.exposure_us, session.other_exposures_us) : 0;
  const again = useAction(() => shootAgain(session.name, frame.index, exposure_us));
  const how = exposure_us > 0 ? `Again at ${digits(exposure_us / 1000)} ms` : 'Again';
  return (
    <>
      <Button kind={exposed?.word === 'over' ? 'plain' : 'quiet'} label={`Shoot ${titleOf(frame)} again`}
        isDisabled={again.isBusy || !rig.value?.can.includes('scan')} onClick={() => void again.run()}>
        {how}
      </Button>
      <Complaint error={again.complaint} />
    </>
  );
}

function roomInWords({clipped, headroom_stops}: Exposed): string {
  if (headroom_stops === null) return `${percentOf(clipped)} is over`;
  return `${headroom_stops.toFixed(1)} stops of room`;
}

function FrameCard({session, frame}: {session: Session; frame: Frame}) {
  const exposed = (frame.led > 0 || frame.role === 'below') && frame.histogram ? exposedOf(frame.histogram) : null;
  const canRepeat = frame.role === 'lit' || frame.role === 'dark';
  return (
    <li class="frame-card">
      <img src={frame.thumbnail} alt={`Photograph: ${titleOf(frame)}`} loading="lazy" />
      <div class="row">
        <strong>{titleOf(frame)}</strong>
        {exposed && <Mark verdict={exposed.verdict}>{exposed.word}</Mark>}
      </div>
      {exposed && <p class="dim">{roomInWords(exposed)}</p>}
      {canRepeat && <Again session={session} frame={frame} exposed={exposed} />}
    </li>
  );
}

/** The relit quick solve, as soon as it is there. */
function Preview({session}: {session: string}) {
  const [solve, show] = useState<string | null>(null);
  useLatest((latest) => {
    show(null);
    return followSolve(session, (found) => void latest(Promise.resolve(found)).then(show));
  }, [session]);
  if (!solve) return <div class="preview waits">The quick solve is on its way</div>;
  return (
    <a class="preview" href={`/viewer/${session}/${solve}`}>
      <img src={relitPicture(session, solve)} alt="The cloth, relit" />
      <span>Open in the viewer</span>
    </a>
  );
}

export function LastScan({session}: {session: Session}) {
  useJobs();
  const current = session.frames.filter((frame) => frame.superseded_by === null);
  return (
    <section class="last-scan" aria-label="Last scan">
      <div class="row">
        <h2>{session.fabric}</h2>
        <a href={`/sessions/${session.name}`}>{session.name}</a>
        <VerdictLine verdict={session.verdict} warnings={session.warnings} />
      </div>
      <div class="results">
        <Preview session={session.name} />
        <ul class="frames">{current.map((frame) => <FrameCard key={frame.index} session={session} frame={frame} />)}</ul>
      </div>
      <Price session={session.name} />
    </section>
  );
}
