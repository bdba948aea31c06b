// SPDX-License-Identifier: Apache-2.0
import {go} from '../../state/address';
import {textIn} from '../../ui/fields';
import {GradeMark} from '../../ui/verdict';
import {addressOfViewer, FIRST_SIGHT} from '../viewer/sight';
import {lastWord} from './edits';
import type {Summary} from './metadata';
import {shelf} from './shelf';

interface SessionTileProps {
  session: Summary;
  isChosen: boolean;
  onChoose: (withRange: boolean) => void;
}

/** The current solves of two beside each other. */
export function compare(one: Summary, other: Summary): void {
  const bare = [one, other].find(({current_solve}) => current_solve === '');
  if (bare) lastWord.value = {says: `${bare.fabric || bare.name} is not solved yet`, error: null};
  else go(addressOfViewer({session: one.name, solve: one.current_solve}, {...FIRST_SIGHT, other: {session: other.name, solve: other.current_solve}, divider: 0.5, panel: 'compare'}));
}

/** The cloth relit, or photographed, with what it is called. Dropped on another it is compared with that. */
export function SessionTile({session, isChosen, onChoose}: SessionTileProps) {
  const {name, fabric, tags, thumbnail, error} = session;
  const drop = (event: DragEvent) => {
    event.preventDefault();
    const dragged = shelf.value.sessions.find((each) => each.name === event.dataTransfer?.getData('text'));
    if (dragged && dragged !== session) compare(dragged, session);
  };
  return (
    <div class={isChosen ? 'session chosen' : 'session'} onDragOver={(event) => event.preventDefault()} onDrop={drop}>
      <a href={`/sessions/${name}`} draggable onDragStart={(event) => event.dataTransfer?.setData('text', name)}>
        <span class="swatch">
          {thumbnail && <img src={thumbnail} alt="" loading="lazy" draggable={false} />}
          {error && <span class="error">{['what', 'why', 'remedy'].map((part) => textIn(error, part)).filter(Boolean).join('. ')}</span>}
        </span>
        {fabric || name}
      </a>
      <label class="choose">
        <input type="checkbox" checked={isChosen} aria-label={`Choose ${name}`} onClick={(event) => onChoose(event.shiftKey)} />
      </label>
      <span class="dim">{name}</span>
      {!error && (
        <span class="tags">
          <GradeMark verdict={session.verdict} />
          {session.solves === 0 && thumbnail && <span class="dim">not solved</span>}
          {tags.map((tag) => <span key={tag} class="tag">{tag}</span>)}
        </span>
      )}
    </div>
  );
}
