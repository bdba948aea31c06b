// SPDX-License-Identifier: Apache-2.0
// What a rig that is not there can be told, in its own words: what breaks, and what lies on its table.
import './virtual_panel.css';
import {Fragment} from 'preact';
import {useEffect, useRef, useState} from 'preact/hooks';
import {answer, api, type Schemas} from '../api/client';
import {useAction} from '../ui/action';
import {Button} from '../ui/button';
import {Complaint} from '../ui/complaint';
import {Field} from '../ui/field';

type Line = Schemas['VirtualRig']['lines'][number];

/** By their first words. A line of one word is about the program and not about the rig. */
function kindsOf(lines: readonly Line[]): Map<string, Line[]> {
  const kinds = new Map<string, Line[]>();
  for (const line of lines) {
    const [kind = '', argument] = line.example.split(' ');
    if (argument !== undefined) kinds.set(kind, [...(kinds.get(kind) ?? []), line]);
  }
  return kinds;
}

export function VirtualPanel() {
  const [lines, setLines] = useState<readonly Line[]>([]);
  const [kind, setKind] = useState('table');
  const [line, setLine] = useState('');
  const [said, setSaid] = useState('');
  const chosen = useRef('');
  const look = useAction(async () => setLines((await answer(api.GET('/api/v1/rig/virtual'))).lines));
  const telling = useAction(async () => {
    setSaid(`${chosen.current} ...`);
    await answer(api.POST('/api/v1/rig/virtual', {body: {line: chosen.current}}));
    setSaid(`${chosen.current}: done`);
  });
  useEffect(() => void look.run(), []);
  const tell = (what: string) => {
    chosen.current = what;
    setLine(what);
    void telling.run();
  };
  const kinds = kindsOf(lines);
  return (
    <aside class="virtual-panel" aria-label="Virtual rig">
      <div class="row">
        <h2>This rig is virtual</h2>
        {[...kinds.keys()].map((name) => (
          <Button key={name} isPressed={name === kind} onClick={() => setKind(name)}>{name}</Button>
        ))}
        <Field label="Tell it" value={line} onInput={setLine} onEnter={() => tell(line)} />
        <span role="status">{telling.complaint ? '' : said}</span>
      </div>
      <Complaint error={look.complaint ?? telling.complaint} />
      <div class="lines">
        {kinds.get(kind)?.map(({example, does}) => (
          <Fragment key={example}>
            <Button isDisabled={telling.isBusy} onClick={() => tell(example)}>{example}</Button>
            <span class="dim">{does}</span>
          </Fragment>
        ))}
      </div>
    </aside>
  );
}
