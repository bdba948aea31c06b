// SPDX-License-Identifier: Apache-2.0
// What a program found, as report/page.h says it.
import {Table} from '../ui/table';
import {Figure, type FigureData} from './figure';

interface TableData {
  header: string[];
  rows: string[][];
  alarms: number[];
  bars: number[];
}

interface SectionData {
  title: string;
  paragraphs: string[];
  table?: TableData;
  figures: FigureData[];
  note: string;
  is_half: boolean;
}

export interface ReportData {
  title: string;
  meta: string[];
  verdicts: {text: string; remedy: string}[];
  summary: string;
  sections: SectionData[];
}

/** A whole report. Where nothing is wrong the summary stands in the place of verdicts. */
export function Report({title, meta, verdicts, summary, sections}: ReportData) {
  const isWell = verdicts.length === 0;
  return (
    <>
      <h1>{title}</h1>
      {[...meta, isWell ? '' : summary].filter(Boolean).map((line) => <p key={line} class="meta">{line}</p>)}
      <div class={isWell ? 'verdict' : 'verdict alarm'}>
        {isWell && <p>{summary}</p>}
        {verdicts.map(({text, remedy}) => [<p key={text}>{text}</p>, remedy && <p class="do">{remedy}</p>])}
      </div>
      {sections.map((section, index) => <Section key={index} {...section} />)}
    </>
  );
}

export function Section({title, paragraphs, table, figures, note, is_half}: SectionData) {
  const isOfPictures = figures.some((figure) => 'png' in figure);
  return (
    <section class={is_half ? 'half' : ''}>
      {title && <h2>{title}</h2>}
      {paragraphs.map((text) => <p key={text}>{text}</p>)}
      {table && <Rows title={title} {...table} />}
      <div class={isOfPictures ? 'pictures' : figures.length > 1 ? 'two' : ''}>
        {figures.map((figure, index) => <Figure key={index} {...figure} />)}
      </div>
      {note && <p class="note">{note}</p>}
    </section>
  );
}

const SENTENCE = 40;

function Rows({title, header, rows, alarms, bars}: TableData & {title: string}) {
  const isOfWords = header.map((_, column) => rows.some((cells) => (cells[column]?.length ?? 0) > SENTENCE));
  const words = (cell: string | undefined, column: number) =>
    isOfWords[column] ? <span class="words">{cell}</span> : cell;
  const barOf = (row: number) => <span class="bar" style={{width: `${100 * (bars[row] ?? 0)}%`}} />;
  return (
    <Table caption={title} heads={header.map(words)}
      rows={rows.map((cells, row) => ({
        key: row,
        isAlarm: alarms.includes(row),
        cells: bars.length > 0 ? [...cells.slice(0, -1), barOf(row), ...cells.slice(-1)] : [small(cells[0]), ...cells.slice(1).map((cell, index) => words(cell, index + 1))],
      }))} />
  );
}

/** What follows a line end is in small letters. */
function small(text = '') {
  const [name, ...more] = text.split('\n');
  return <>{name}{more.map((line) => <p key={line} class="note">{line}</p>)}</>;
}
