// SPDX-License-Identifier: Apache-2.0
import type {Schemas} from '../api/client';
import {Mark, type Verdict} from './mark';
import {counted} from './say';

type ScanVerdict = Schemas['ScanVerdict'];

const grades: Record<ScanVerdict['grade'], Verdict> = {good: 'fine', usable: 'warning', 'take it again': 'fault', unfinished: 'waiting'};

/** What a scan is worth; the pointer shows why. */
export function GradeMark({verdict: {grade, says, action}}: {verdict: ScanVerdict}) {
  return <span title={[says, action].filter(Boolean).join('; ')}><Mark verdict={grades[grade]}>{grade}</Mark></span>;
}

/** What a scan is worth, why, and the one thing to do; what it was warned of where somebody asks. */
export function VerdictLine({verdict, warnings}: {verdict: ScanVerdict; warnings: readonly string[]}) {
  return (
    <>
      <p><GradeMark verdict={verdict} /> {verdict.says}. <strong>{verdict.action}</strong></p>
      {warnings.length > 0 && (
        <details>
          <summary>{counted(warnings.length, 'warning')}</summary>
          <ul>{warnings.map((warning) => <li key={warning}>{warning}</li>)}</ul>
        </details>
      )}
    </>
  );
}
