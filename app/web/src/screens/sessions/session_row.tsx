// SPDX-License-Identifier: Apache-2.0
import {counted} from '../../ui/say';
import {textIn} from '../../ui/fields';
import {bytesOf, timeOf} from '../../ui/words';
import type {Summary} from './metadata';
import {GradeMark} from '../../ui/verdict';

/** The cloth relit, or photographed; an empty place where there is neither. */
function Thumbnail({session: {thumbnail}}: {session: Summary}) {
  return <div class="thumbnail">{thumbnail && <img src={thumbnail} alt="" loading="lazy" decoding="async" />}</div>;
}

interface SessionRowProps {
  session: Summary;
  isChosen: boolean;
  onChoose: (withRange: boolean) => void;
}

export function SessionRow({session, isChosen, onChoose}: SessionRowProps) {
  const {name, fabric, tags, taken} = session;
  return (
    <div class={isChosen ? 'session chosen' : 'session'}>
      <label class="choose">
        <input type="checkbox" checked={isChosen} aria-label={`Choose ${name}`}
          onClick={(event) => onChoose(event.shiftKey)} />
      </label>
      <Thumbnail session={session} />
      <div class="what">
        <a href={`/sessions/${name}`}>{fabric || name}</a>
        <span class="name dim">{name}</span>
      </div>
      <div class="tags">{tags.map((tag) => <span key={tag} class="tag">{tag}</span>)}</div>
      {session.error ? (
        <span class="error">{['what', 'why', 'remedy'].map((part) => textIn(session.error, part)).filter(Boolean).join('. ')}</span>
      ) : (
        <>
          <span class="state">
            <GradeMark verdict={session.verdict} />
          </span>
          <span class="numbers dim">{session.solves > 0 ? counted(session.solves, 'solve') : 'not solved'}</span>
          <span class="numbers dim">{taken && timeOf(taken)}</span>
          <span class="numbers dim">{bytesOf(session.bytes)}</span>
        </>
      )}
    </div>
  );
}
