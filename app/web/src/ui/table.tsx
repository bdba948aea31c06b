// SPDX-License-Identifier: Apache-2.0
import type {ComponentChildren} from 'preact';

interface TableProps {
  /** What it is of, for who hears it read. */
  caption: string;
  heads: readonly ComponentChildren[];
  rows: readonly {key: string | number; isAlarm?: boolean; cells: readonly ComponentChildren[]}[];
}

/** Rows whose first cell names them. */
export function Table({caption, heads, rows}: TableProps) {
  return (
    <table>
      <caption class="unseen">{caption}</caption>
      <thead>
        <tr>{heads.map((head, index) => <th key={index} scope="col">{head}</th>)}</tr>
      </thead>
      <tbody>
        {rows.map(({key, isAlarm, cells: [name, ...cells]}) => (
          <tr key={key} class={isAlarm ? 'alarm' : undefined}>
            <th scope="row">{name}</th>
            {cells.map((cell, index) => <td key={index}>{cell}</td>)}
          </tr>
        ))}
      </tbody>
    </table>
  );
}
