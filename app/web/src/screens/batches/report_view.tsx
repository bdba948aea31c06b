// SPDX-License-Identifier: Apache-2.0
import {useEffect, useState} from 'preact/hooks';
import {answer, api, type Schemas} from '../../api/client';
import {clothOf} from '../../state/cloths';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {ClothName} from '../../ui/cloth_name';
import {Complaint} from '../../ui/complaint';
import {Dialog} from '../../ui/dialog';
import {Mark} from '../../ui/mark';
import {counted, degrees, degreesOn, digits} from '../../ui/say';
import {Table} from '../../ui/table';
import {percentOf} from '../../ui/words';
import {acceptanceInWords, changeInCells, type BatchReport} from './changes';

interface ReportProps {
  name: string;
  report: BatchReport;
  onAccepted: () => void;
}

/** What changed: regressions first, then what turned most. */
export function ReportView({name, report, onAccepted}: ReportProps) {
  const [isAsked, ask] = useState(false);
  const files = `/api/v1/batches/${name}/files/`;
  return (
    <section class="panel" aria-labelledby="report-title">
      <h2 id="report-title">What changed</h2>
      {report.verdicts.map(({name: verdict, text, remedy}) => (
        <p key={verdict}><Mark verdict="warning">{text}</Mark> {remedy && <span class="dim">{remedy}</span>}</p>
      ))}
      {report.causes.map(({what, sessions, example}) => <p key={what}><Mark verdict="fault">{counted(sessions, 'session')}: {example}</Mark></p>)}
      {report.seconds > 0 && (
        <p>
          {degreesOn(report.mean_deg, report.mean_solved)} of the cloth, {degreesOn(report.predicted_deg, report.predicted_solved)} predicted;
          seconds predicted were {digits(report.seconds_ratio)} times those taken.
        </p>
      )}
      {report.barely_solved.length > 0 && (
        <>
          <p><Mark verdict="warning">Most of the cloth has no normal</Mark></p>
          <Cloths sessions={report.barely_solved} />
        </>
      )}
      {report.warned.length > 0 && (
        <details>
          <summary>{counted(report.warned.length, 'session')} solved with warnings</summary>
          <Cloths sessions={report.warned} />
        </details>
      )}
      <p>{counted(report.changed, 'session')} compared with the solve before, {report.worse} worse in something, {report.unchanged} without a changed pixel.</p>
      <div class="row">
        <Button kind="main" onClick={() => ask(true)}>Accept...</Button>
        {report.has_page && <a href={`${files}report.html`} target="_blank">The whole report</a>}
      </div>
      {report.changes.length > 0 && (
        <Table caption="Changes" heads={['Session', 'Turned by', '95 % under', 'Albedo', 'Sigma', 'Worse in']}
          rows={report.changes.map((each) => ({
            key: each.session,
            cells: [
              <a href={`/viewer/${each.session}/${each.solve}`}><ClothName session={each.session} /></a>, ...changeInCells(each),
              each.regressions.length > 0 && <Mark verdict="warning">{each.regressions.join('; ')}</Mark>,
            ],
          }))} />
      )}
      <Table caption="Calibrations" heads={['Calibration', 'Rig', 'Sessions', 'Worse', 'Lights do not fit', 'Left-out lights off by', 'Turned by']}
        rows={report.calibrations.map((each) => ({
          key: each.calibration,
          cells: [
            each.calibration.slice(0, 12), each.rig, each.sessions, each.worse, each.warned,
            each.left_out === null ? '' : percentOf(each.left_out), each.mean_turn_deg === null ? '' : degrees(each.mean_turn_deg),
          ],
        }))} />
      {report.changes.filter(({picture}) => picture !== null).map(({session, picture}) => (
        <figure key={session}>
          <img src={files + picture} alt={`${clothOf(session)}: before, after, after relit, change`} loading="lazy" />
          <figcaption class="dim"><ClothName session={session} />: before, after, after relit, change</figcaption>
        </figure>
      ))}
      {isAsked && <Acceptance name={name} worse={report.worse} onClose={() => ask(false)} onAccepted={onAccepted} />}
    </section>
  );
}

function Cloths({sessions}: {sessions: readonly string[]}) {
  return <ul>{sessions.map((session) => <li key={session}><a href={`/sessions/${session}`}><ClothName session={session} /></a></li>)}</ul>;
}

interface AcceptanceProps {
  name: string;
  worse: number;
  onClose: () => void;
  onAccepted: () => void;
}

/** Says how many sessions get another current solve, and asks. */
function Acceptance({name, worse, onClose, onAccepted}: AcceptanceProps) {
  const [with_worse, setWithWorse] = useState(false);
  const [would, say] = useState<Schemas['Acceptance'] | null>(null);
  const accept = (dry_run: boolean) =>
    answer(api.POST('/api/v1/batches/{name}/accept', {params: {path: {name}}, body: {with_worse, dry_run}}));
  const look = useAction(async () => say(await accept(true)));
  const make = useAction(async () => {
    await accept(false);
    onAccepted();
    onClose();
  });
  useEffect(() => void look.run(), [with_worse]);
  return (
    <Dialog title="Accept the new solves" onClose={onClose}>
      {would && <p role="status">{acceptanceInWords(would)}</p>}
      {worse > 0 && (
        <label class="row">
          <input type="checkbox" checked={with_worse} onChange={(event) => setWithWorse(event.currentTarget.checked)} />
          Also the {counted(worse, 'session')} that became worse
        </label>
      )}
      {would && would.left_sessions.length > 0 && (
        <ul>{would.left_sessions.slice(0, 10).map(({session, why}) => <li key={session}><ClothName session={session} />: {why}</li>)}</ul>
      )}
      <Complaint error={look.complaint ?? make.complaint} />
      <div class="row">
        <Button kind="main" isDisabled={!would?.moved || make.isBusy || look.isBusy} onClick={() => void make.run()}>
          Accept {would?.moved ?? ''}
        </Button>
        <Button onClick={onClose}>Leave all as it is</Button>
      </div>
    </Dialog>
  );
}
