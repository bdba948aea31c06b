// SPDX-License-Identifier: Apache-2.0
// What a maps.json says: what speaks against the maps, what each step found, where each map comes from.
import {fieldsOf, isFields, listIn, numberIn, textIn} from '../../ui/fields';
import {Mark, type Verdict} from '../../ui/mark';
import {digits} from '../../ui/say';
import {Table} from '../../ui/table';
import {addressOfMaps} from '../viewer/maps';
import type {SolveName} from '../viewer/sight';

export function Verdicts({document}: {document: unknown}) {
  const verdicts = listIn(document, 'verdicts');
  if (verdicts.length === 0) return <p><Mark verdict="fine">nothing speaks against these maps</Mark></p>;
  return (
    <ul class="verdicts">
      {verdicts.map((verdict, index) => (
        <li key={index}>
          <Mark verdict="warning">{textIn(verdict, 'text') || textIn(verdict, 'name')}</Mark> <span class="dim">{textIn(verdict, 'remedy')}</span>
        </li>
      ))}
    </ul>
  );
}

/** Numbers and words among the facts of a step; lists are left to its maps.json. */
export function factsInWords(facts: unknown): string {
  return Object.entries(fieldsOf(facts)).flatMap(([name, value]) => {
    const says = name.replaceAll('_', ' ');
    if (typeof value === 'number') return [`${says} ${Number.isInteger(value) ? value : digits(value, 3)}`];
    if (typeof value === 'string') return value === '' ? [] : [`${says} ${value}`];
    if (isFields(value)) return [`${says}: ${factsInWords(value)}`];
    return typeof value === 'boolean' ? [`${says} ${value ? 'yes' : 'no'}`] : [];
  }).join(', ');
}

/** Pictures of what steps ask about. */
export function StepPictures({of, document}: {of: SolveName; document: unknown}) {
  const files = listIn(document, 'steps').map((step) => textIn(fieldsOf(step)['facts'], 'picture')).filter((file) => file !== '');
  return <>{files.map((file) => <img key={file} class="asked" alt="Where the yarns seem to lie" src={`${addressOfMaps(of)}/pictures/${file}`} />)}</>;
}

export function StepFacts({document}: {document: unknown}) {
  const steps = listIn(document, 'steps').map((step) => ({name: textIn(step, 'do'), says: factsInWords(fieldsOf(step)['facts'])}));
  return <ul class="facts">{steps.map(({name, says}, index) => says && <li key={index}><strong>{name}</strong> <span class="dim">{says}</span></li>)}</ul>;
}

const severities: Record<string, Verdict> = {passed: 'fine', warning: 'warning', error: 'fault'};

/** What was checked of the maps, and how it came out. */
function Checks({document}: {document: unknown}) {
  const checks = listIn(document, 'checks');
  if (checks.length === 0) return null;
  return (
    <details class="checks">
      <summary>{checks.length} checks</summary>
      <ul>
        {checks.map((check, index) => (
          <li key={index}><Mark verdict={severities[textIn(check, 'severity')] ?? 'waiting'}>{textIn(check, 'text')}</Mark></li>
        ))}
      </ul>
    </details>
  );
}

/** The maps of a set, each with where it comes from. */
export function MadePanel({of, document}: {of: SolveName; document: unknown}) {
  return (
    <section class="made">
      <h2>What was made</h2>
      <Verdicts document={document} />
      <StepPictures of={of} document={document} />
      <Checks document={document} />
      <StepFacts document={document} />
      <Table caption="Maps" heads={['Map', 'From', 'Least', 'Most', 'Mean']}
        rows={listIn(document, 'maps').filter(isFields).map((map) => ({key: textIn(map, 'name'), cells: cellsOf(map)}))} />
    </section>
  );
}

function cellsOf(map: unknown) {
  const constant = numberIn(map, 'constant');
  const number = (key: string) => {
    const value = constant ?? numberIn(map, key);
    return value === null ? '' : String(Number(value.toPrecision(3)));
  };
  const unit = textIn(map, 'unit');
  const source = textIn(map, 'source');
  return [
    <>{textIn(map, 'name')} <span class="dim">{unit}{constant === null ? '' : ` ${textIn(map, 'why')}`}</span></>,
    source === 'assumed' ? <Mark verdict="warning">assumed</Mark> : source,
    number('least'),
    number('most'),
    number('mean'),
  ];
}
