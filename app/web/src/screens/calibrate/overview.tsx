// SPDX-License-Identifier: Apache-2.0
// How well the rig is known: each part, the last check, what is missing, and what was measured over time.
import {useState} from 'preact/hooks';
import {verdictOfPlace} from '../../frame/rig_words';
import {go} from '../../state/address';
import {rig} from '../../state/rig';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {Dialog} from '../../ui/dialog';
import {Mark} from '../../ui/mark';
import {age} from '../../ui/say';
import {Table} from '../../ui/table';
import {timeOf} from '../../ui/words';
import {Acceptance} from './acceptance';
import {AffectedSessions} from './affected';
import {calibrations, complaint, findings, history, isKnown, known, work} from './calibrations';
import {DatedPlot} from './dated_plot';
import {seriesOfCamera, seriesOfFluxes, seriesOfPlaces} from './history';
import {LightPlanPanel} from './light_plan_panel';
import {currentStage, freeName, walkOfSet, walksIn, type CheckResult, type Listed, type WalkKind} from './walk';

const parts = [
  {part: 'camera', says: 'Lens and place'},
  {part: 'response', says: 'Sensor'},
  {part: 'lights', says: 'Lights'},
  {part: 'color', says: 'Colour'},
];

export function Overview() {
  const rigs = calibrations.value.find((each) => each.is_rigs) ?? null;
  return (
    <div class="page overview">
      <h1>Calibration of the rig</h1>
      <Complaint error={complaint.value} />
      {isKnown.value && <State rigs={rigs} />}
      {rigs && history.value.affected.length > 0 && (
        <AffectedSessions sessions={history.value.affected} calibration={rigs.folder} />
      )}
      <LightPlanPanel />
      <History />
      <AllCalibrations />
    </div>
  );
}

function State({rigs}: {rigs: Listed | null}) {
  const place = rig.value?.place;
  return (
    <section class="panel" aria-label="State">
      <ul class="parts">
        {parts.map(({part, says}) => (
          <li key={part}>
            <strong>{says}</strong>
            {rigs?.parts.includes(part)
              ? <Mark verdict="fine">measured {age(rigs.measured ?? '')}</Mark>
              : <Mark verdict={part === 'color' ? 'waiting' : 'fault'}>missing</Mark>}
          </li>
        ))}
        <li><strong>Last check</strong><LastCheck rigs={rigs} /></li>
      </ul>
      {place && (
        <p>
          <Mark verdict={verdictOfPlace(place)}>{place.says}</Mark> <span class="dim">{place.action}</span>{' '}
          <a href={`/sessions/${place.session}`}>by the scan of {timeOf(place.taken)}</a>
        </p>
      )}
      {findings.value.filter((finding) => finding.verdict !== 'fine').map((finding) => (
        <p key={finding.says}><Mark verdict={finding.verdict}>{finding.says}</Mark> <span class="dim">{finding.remedy}</span></p>
      ))}
      <Walks isKnownRig={rigs !== null} />
    </section>
  );
}

function LastCheck({rigs}: {rigs: Listed | null}) {
  const check = rigs?.check as {date: string; passed: boolean} | null | undefined;
  if (!check) return <Mark verdict="waiting">nobody has checked it</Mark>;
  const says = `${check.passed ? 'passed' : 'did not pass'}, ${age(check.date)}`;
  return <Mark verdict={check.passed ? 'fine' : 'fault'}>{says}</Mark>;
}

/** Where one can begin, and what was begun. */
function Walks({isKnownRig}: {isKnownRig: boolean}) {
  const walks = walksIn(known.value);
  const begin = (kind: WalkKind) => {
    const day = new Date().toISOString().slice(0, 10);
    go(`/calibrate/${kind}/${freeName(day, walks)}`);
  };
  const begun = work.value ? walkOfSet(work.value) : null;
  const current = begun && currentStage(begun, known.value) !== null ? begun : null;
  return (
    <div class="row">
      {current && <a class="button main" href={`/calibrate/${current.kind}/${current.name}`}>Go on with {current.name}</a>}
      <Button kind={isKnownRig ? 'plain' : 'main'} onClick={() => begin('all')}>Calibrate everything</Button>
      <Button isDisabled={!isKnownRig} onClick={() => begin('refresh')}>After a knock</Button>
      {walks.slice(0, 3).map(({kind, name}) => <a key={name} href={`/calibrate/${kind}/${name}`}>{name}</a>)}
    </div>
  );
}

function History() {
  const {summary, checks, costs, warnings} = history.value;
  if (summary === '') return null;
  return (
    <section class="panel" aria-labelledby="history-title">
      <h2 id="history-title">History <span class="dim">{summary}</span></h2>
      {warnings.map((warning) => <p key={warning}><Mark verdict="warning">{warning}</Mark></p>)}
      <div class="plots">
        <DatedPlot title="Each LED from where it was first" unit="mm" leastSpan={1} series={seriesOfPlaces(history.value)} checks={checks} />
        <DatedPlot title="Light of each LED, of its first" unit="%" leastSpan={2} series={seriesOfFluxes(history.value)} checks={checks} />
        <DatedPlot title="Height of the camera" unit="mm" leastSpan={1} series={seriesOfCamera(history.value)} checks={checks} />
        <DatedPlot title="What a move cost each scan" unit="degrees" leastSpan={0.1} series={[{name: '', points: costs}]} checks={checks} />
      </div>
      {checks.length > 0 && (
        <Table caption="Checks" heads={['Check', 'When', 'Result']}
          rows={[...checks].reverse().map((check) => ({
            key: check.folder,
            cells: [
              check.folder,
              timeOf(check.date),
              <Found check={check} />,
            ],
          }))} />
      )}
    </section>
  );
}

function Found({check}: {check: CheckResult}) {
  if (check.passed) return <Mark verdict="fine">passed</Mark>;
  return <Mark verdict="warning">found {check.found || 'what its report says'}</Mark>;
}

function AllCalibrations() {
  const [asked, ask] = useState<string | null>(null);
  if (calibrations.value.length === 0) return null;
  return (
    <section class="panel" aria-labelledby="all-title">
      <h2 id="all-title">Calibrations beside the rig file</h2>
      <Table caption="Calibrations" heads={['Folder', 'Measured', 'Parts', 'Last check', 'Id', 'Of the rig']}
        rows={calibrations.value.map((each) => ({
          key: each.folder,
          cells: [
            each.folder,
            each.measured === null ? '' : timeOf(each.measured),
            each.parts.join(', '),
            <LastCheck rigs={each} />,
            <code>{each.id.slice(0, 12)}</code>,
            each.is_rigs
              ? <Mark verdict="fine">the rig's</Mark>
              : <Button kind="quiet" label={`What accepting ${each.folder} changes`} onClick={() => ask(each.folder)}>Accept ...</Button>,
          ],
        }))} />
      {asked !== null && (
        <Dialog title={asked} onClose={() => ask(null)}>
          <Acceptance folder={asked} />
          <form method="dialog"><button class="button">Close</button></form>
        </Dialog>
      )}
    </section>
  );
}
