// SPDX-License-Identifier: Apache-2.0
import {useState} from 'preact/hooks';
import {answer, api, type ApiError, asApiError} from '../../api/client';
import {Complaint} from '../../ui/complaint';
import {digits} from '../../ui/say';
import {useLatest} from '../../ui/use_latest';
import type {SolveName} from './sight';
import {type Gate, type LeftOutCheck, partsOf, type SolveReport, type SolveStage, stagesOf} from './why';
import type {Viewer} from './viewer';

function useReport({session, solve}: SolveName): {report: SolveReport | null; complaint: ApiError | null} {
  const [report, setReport] = useState<SolveReport | null>(null);
  const [complaint, setComplaint] = useState<ApiError | null>(null);
  useLatest((latest) => {
    if (solve === 'truth') return;
    const path = {name: session, solve};
    latest(answer(api.GET('/api/v1/sessions/{name}/solves/{solve}/report', {params: {path}}))).then(
      setReport,
      (error: unknown) => setComplaint(asApiError(error)),
    );
  }, [session, solve]);
  return {report, complaint};
}

/** Why the maps are as they are. */
export function WhyPanel({viewer}: {viewer: Viewer}) {
  const {report, complaint} = useReport(viewer.name);
  if (viewer.name.solve === 'truth') return <section><p class="dim">The truth of a simulation was not solved.</p></section>;
  return (
    <section class="why">
      <h2>Why it is so</h2>
      <Complaint error={complaint} />
      {report && <Told report={report} />}
    </section>
  );
}

function Told({report}: {report: SolveReport}) {
  const {warnings, check, gates, seconds} = partsOf(report);
  return (
    <>
      {warnings.map(({name, text, remedy}) => (
        <p key={text} class="warning">▲ {name}: {text} <span class="dim">{remedy}</span></p>
      ))}
      {check && <LeftOutInWords check={check} />}
      <ul class="stages" aria-label={`Stages of ${report.method}`}>{stagesOf(report).map((stage) => <StageRow key={stage.name} stage={stage} />)}</ul>
      {gates.length > 0 && <Gates gates={gates} />}
      {check && <LeftOutByLed check={check} />}
      <Seconds seconds={seconds} />
    </>
  );
}

function StageRow({stage: {name, ran, says}}: {stage: SolveStage}) {
  return (
    <li class={ran ? 'ran' : ''}>
      <strong>{ran ? '●' : '○'} {name}</strong> <span class="dim">{ran ? 'ran' : 'did not run'}</span>
      <p>{says}</p>
    </li>
  );
}

const percent = (share: number) => `${digits(100 * share)} %`;

function LeftOutInWords({check}: {check: LeftOutCheck}) {
  const noise = check.noise_median === undefined ? '' : `; noise alone would give ${percent(check.noise_median)}`;
  return (
    <>
      <p>Each light was left out in turn and predicted from the others: the median misses by {percent(check.median)}{noise}.</p>
      <p class="dim">It cannot see what all lights share: a common scale of the albedo, a slow common tilt.</p>
    </>
  );
}

function LeftOutByLed({check}: {check: LeftOutCheck}) {
  return (
    <table>
      <caption>Left-out light, by LED</caption>
      <thead><tr><th scope="col">LED</th><th scope="col">Missed by</th><th scope="col">Noise alone</th></tr></thead>
      <tbody>
        {check.lights.map(({light, median, noise_median}) => (
          <tr key={light}>
            <th scope="row">{light}</th>
            <td>{percent(median)}</td>
            <td>{noise_median === undefined ? '' : percent(noise_median)}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

function Gates({gates}: {gates: readonly Gate[]}) {
  return (
    <table>
      <caption>What asks for more than the standard solve</caption>
      <thead><tr><th scope="col">Gate</th><th scope="col">Measured</th><th scope="col">Limit</th><th scope="col" /></tr></thead>
      <tbody>
        {gates.map(({name, value, limit, unit, verdict}) => (
          <tr key={name}>
            <th scope="row">{name} <span class="dim">{unit}</span></th>
            <td>{digits(value)}</td>
            <td>{digits(limit)}</td>
            <td>{verdict === 'over' ? '▲ over' : 'under'}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

function Seconds({seconds}: {seconds: Record<string, number>}) {
  const phases = Object.entries(seconds);
  const sum = phases.reduce((before, [, each]) => before + each, 0);
  return (
    <table>
      <caption>Seconds by phase, {digits(sum)} s in all</caption>
      <tbody>{phases.map(([phase, each]) => <tr key={phase}><th scope="row">{phase}</th><td>{digits(each)} s</td></tr>)}</tbody>
    </table>
  );
}
