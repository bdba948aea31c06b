// SPDX-License-Identifier: Apache-2.0
import {useState} from 'preact/hooks';
import {asApiError, type ApiError, type Schemas} from '../../api/client';
import {Complaint} from '../../ui/complaint';
import {Mark} from '../../ui/mark';
import {shutter} from '../../ui/say';
import {percentOf} from '../../ui/words';
import {change} from './edits';
import {clippedShare, clippingVerdict, leftOut, standing, type SessionFrame} from './one_session';

interface FramesProps {
  session: Schemas['Session'];
  onChanged: () => void;
}

/** The photographs of a session, each with what a person must know of it. Lit ones may be left out of every solve. */
export function Frames({session, onChanged}: FramesProps) {
  const [complaint, complain] = useState<ApiError | null>(null);
  const leaveOut = (index: number, out: boolean) => {
    complain(null);
    change(session.name, {left_out: leftOut(session.left_out, index, out)})
      .then(onChanged, (error: unknown) => complain(asApiError(error)));
  };
  return (
    <>
      <Complaint error={complaint} />
      <ul class="frames">
        {standing(session.frames).map((frame) => (
          <li key={frame.index}>
            <a href={frame.raw} download><img src={frame.thumbnail} alt={titleOf(frame)} loading="lazy" decoding="async" /></a>
            <strong>{titleOf(frame)}</strong>
            {frame.exposure_us > 0 && <span class="dim numbers">{shutter(frame.exposure_us)}, ISO {frame.iso}, f/{frame.f_number}</span>}
            <Clipping frame={frame} />
            {frame.warnings.map((warning) => <span key={warning} class="warning">{warning}</span>)}
            {frame.role === 'lit' && (
              <LeaveOut isOut={session.left_out.includes(frame.index)} of={titleOf(frame)}
                onTurn={(out) => leaveOut(frame.index, out)} />
            )}
          </li>
        ))}
      </ul>
    </>
  );
}

function LeaveOut({isOut, of, onTurn}: {isOut: boolean; of: string; onTurn: (out: boolean) => void}) {
  return (
    <label class="leave-out">
      <input type="checkbox" checked={!isOut} aria-label={`${of} is used`} onChange={(event) => onTurn(!event.currentTarget.checked)} />
      {isOut ? 'left out of solves' : 'used'}
    </label>
  );
}

function titleOf({led, role, polariser}: SessionFrame): string {
  const light = led > 0 ? `LED ${led}` : 'No light';
  const how = role === 'lit' || role === 'dark' ? '' : `, ${role}`;
  return polariser === 'none' ? light + how : `${light}${how}, ${polariser}`;
}

function Clipping({frame}: {frame: SessionFrame}) {
  const share = clippedShare(frame);
  if (share === null) return <span class="dim">being counted</span>;
  const words = {fine: 'in range', warning: 'near full', fault: 'over'};
  const verdict = clippingVerdict(share);
  return <Mark verdict={verdict}>{words[verdict]}{share > 0 && `, ${percentOf(share)} full`}</Mark>;
}
