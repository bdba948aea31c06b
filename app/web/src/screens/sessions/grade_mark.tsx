// SPDX-License-Identifier: Apache-2.0
import type {Schemas} from '../../api/client';
import {Mark, type Verdict} from '../../ui/mark';

type ScanVerdict = Schemas['ScanVerdict'];

const grades: Record<ScanVerdict['grade'], Verdict> = {good: 'fine', usable: 'warning', 'take it again': 'fault', unfinished: 'waiting'};

/** What a scan is worth; the pointer shows why. */
export function GradeMark({verdict: {grade, says, action}}: {verdict: ScanVerdict}) {
  return <span title={[says, action].filter(Boolean).join('; ')}><Mark verdict={grades[grade]}>{grade}</Mark></span>;
}
