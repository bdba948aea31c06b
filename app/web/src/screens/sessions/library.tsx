// SPDX-License-Identifier: Apache-2.0
// All sessions: found, chosen, tagged, sent to be solved.
import {useEffect, useState} from 'preact/hooks';
import {amend, place} from '../../state/address';
import {rig} from '../../state/rig';
import {useKeys} from '../../state/keys';
import {Button} from '../../ui/button';
import {Choice} from '../../ui/choice';
import {Complaint} from '../../ui/complaint';
import {Empty} from '../../ui/empty';
import {Field} from '../../ui/field';
import {counted} from '../../ui/say';
import {VirtualList} from '../../ui/virtual_list';
import {BatchBar} from './batch_bar';
import {addressOf, filtersIn, isNarrowed, type Filters, noFilters, states} from './filters';
import {LastWord} from './last_word';
import {Photographs} from './photographs';
import {SessionTile} from './session_tile';
import {all, extended, nothing, toggled} from './selection';
import {askMore, askTags, complaint, look, shelf, tags} from './shelf';

/** A tile is at least as wide, and higher by its words. */
const least_px = 175;
const words_px = 72;
/** Sessions are asked for before they come into view. */
const rowsAhead = 100;

export function Library() {
  const filters = filtersIn(place.value.query);
  const asked = place.value.query.toString();
  const [selection, select] = useState(nothing);
  const [end, setEnd] = useState(0);
  const {sessions, total} = shelf.value;
  const isKnown = shelf.value.search > 0;
  const names = sessions.map((session) => session.name);

  const again = () => {
    void look(filters);
    void askTags();
  };
  useEffect(again, [asked, rig.value?.state, rig.value?.session]);
  useEffect(() => {
    addEventListener('focus', again);
    return () => removeEventListener('focus', again);
  }, [asked]);
  useEffect(() => {
    if (end + rowsAhead > sessions.length) void askMore();
  }, [end, shelf.value]);
  useKeys('sessions', [
    {key: 'Escape', does: 'choose none', run: () => select(nothing)},
    {key: 'Ctrl+a', does: 'choose all', run: () => select(all(names))},
    {key: 'ArrowRight', does: 'next session', run: () => step(1, false)},
    {key: 'ArrowLeft', does: 'session before', run: () => step(-1, false)},
    {key: 'ArrowDown', does: 'session below', run: () => step(1, true)},
    {key: 'ArrowUp', does: 'session above', run: () => step(-1, true)},
  ]);

  const choose = (name: string, withRange: boolean) =>
    select(withRange ? extended(selection, name, names) : toggled(selection, name));
  const chosen = sessions.filter((session) => selection.names.has(session.name));
  return (
    <div class="library">
      <div class="row head">
        <h1>Library</h1>
        <span class="dim" role="status">{isKnown && counted(total, 'session')}</span>
        {total > 0 && <a href={`/batches?plan=found&${asked}`}>Plan a night...</a>}
        <LastWord onStep={again} />
      </div>
      <FilterBar filters={filters} onChange={(changed: Filters) => amend(addressOf(changed))} />
      <div class="wall">
        <Complaint error={complaint.value} />
        <Photographs onMade={again} />
        {isKnown && total === 0 && <Nothing isNarrowed={isNarrowed(filters)} />}
        <VirtualList label="Sessions" count={total} least_px={least_px} more_px={words_px} keyOf={(index) => names[index] ?? index}
          onRange={(range) => setEnd(range.end)} render={(index) => {
            const session = sessions[index];
            if (!session) return <div class="session dim">...</div>;
            return (
              <SessionTile session={session} isChosen={selection.names.has(session.name)}
                onChoose={(withRange) => choose(session.name, withRange)} />
            );
          }} />
        {chosen.length > 0 && (
          <BatchBar chosen={chosen} onAll={() => select(all(names))} onNone={() => select(nothing)} onChanged={again} />
        )}
      </div>
    </div>
  );
}

interface FilterBarProps {
  filters: Filters;
  onChange: (filters: Filters) => void;
}

const stateChoices = [
  {value: '', says: 'any'},
  ...states.map((state) => ({value: state, says: state === 'capturing' ? 'unfinished' : state})),
];

function FilterBar({filters, onChange}: FilterBarProps) {
  const search = () => document.querySelector<HTMLInputElement>('#library-search')?.select();
  useKeys('sessions', [{key: '/', does: 'search', run: search}]);
  const put = <K extends keyof Filters>(key: K) => (value: Filters[K]) => onChange({...filters, [key]: value});
  return (
    <div class="filters" role="search">
      <Field id="library-search" label="Search" type="search" value={filters.words} onInput={put('words')}
        placeholder="name, fabric, tag, composition, notes" />
      <Field label="Tag" value={filters.tag} onInput={put('tag')} list={tags.value} />
      <Choice label="State" value={filters.state} options={stateChoices} onChange={put('state')} />
      <Field label="From" type="date" value={filters.from} onInput={put('from')} />
      <Field label="To" type="date" value={filters.to} onInput={put('to')} />
      <Field label="Calibration" value={filters.calibration} onInput={put('calibration')} placeholder="id" />
      <label class="check">
        <input type="checkbox" checked={filters.warned} onChange={(event) => put('warned')(event.currentTarget.checked)} />
        Not good
      </label>
      <Button kind="quiet" isDisabled={!isNarrowed(filters)} onClick={() => onChange(noFilters)}>Clear</Button>
    </div>
  );
}

function Nothing({isNarrowed: isSearch}: {isNarrowed: boolean}) {
  if (isSearch) return <Empty says="No session is like that. Take a word or a filter away." />;
  return (
    <Empty says="No cloth was scanned yet.">
      <p><a href="/tour">Ways to begin</a></p>
    </Empty>
  );
}

/** The focus goes to the tile before, after, above or below the one that has it. */
function step(by: 1 | -1, isRow: boolean): void {
  const links = [...document.querySelectorAll<HTMLElement>('.session a')];
  const top = (link?: HTMLElement) => link?.getBoundingClientRect().top;
  const columns = links.findIndex((link) => top(link) !== top(links[0]));
  const at = links.findIndex((link) => link.parentElement?.contains(document.activeElement));
  links[Math.max(0, Math.min(at + by * (isRow && at >= 0 && columns > 0 ? columns : 1), links.length - 1))]?.focus();
}
