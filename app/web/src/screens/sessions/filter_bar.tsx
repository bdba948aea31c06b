// SPDX-License-Identifier: Apache-2.0
import {useKeys} from '../../state/keys';
import {Button} from '../../ui/button';
import {Choice} from '../../ui/choice';
import {Field} from '../../ui/field';
import {isNarrowed, noFilters, states, type Filters} from './filters';
import {tags} from './shelf';

interface FilterBarProps {
  filters: Filters;
  onChange: (filters: Filters) => void;
}

const stateChoices = [
  {value: '', says: 'any'},
  ...states.map((state) => ({value: state, says: state === 'capturing' ? 'unfinished' : state})),
];

export function FilterBar({filters, onChange}: FilterBarProps) {
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
        With warnings
      </label>
      <Button kind="quiet" isDisabled={!isNarrowed(filters)} onClick={() => onChange(noFilters)}>Clear</Button>
    </div>
  );
}
