// SPDX-License-Identifier: Apache-2.0
// What is wrong with the set-up and what mends it, by the daemon and by the page itself.
import './doctor.css';
import {useEffect, useState} from 'preact/hooks';
import {answer, api, asApiError, type ApiError, type Schemas} from '../../api/client';
import {version} from '../../state/rig';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {Copy} from '../../ui/copy';
import {Mark} from '../../ui/mark';
import {AskHardCases} from '../jobs/torture';

type Doctor = Schemas['Doctor'];
type Finding = Doctor['findings'][number];

const order = {fault: 0, warning: 1, fine: 2};

/** A remedy that is a command begins with the name of a program. */
function isCommand(remedy: string): boolean {
  return /^(sudo|weft|systemctl|chmod|openssl|ls|gio|ssh|timedatectl)\b/.test(remedy);
}

function Row({part, verdict, says, remedy}: Finding) {
  return (
    <li class="finding">
      <Mark verdict={verdict}>{verdict}</Mark>
      <div>
        <h3>{part}</h3>
        <p>{says}</p>
        {remedy && (
          <div class="row">
            {isCommand(remedy) ? <code>{remedy}</code> : <p>{remedy}</p>}
            <Copy text={remedy} />
          </div>
        )}
      </div>
    </li>
  );
}

function Findings({title, findings}: {title: string; findings: readonly Finding[]}) {
  const sorted = [...findings].sort((one, other) => order[one.verdict] - order[other.verdict]);
  return (
    <section class="panel">
      <h2>{title}</h2>
      <ul class="findings">{sorted.map((finding) => <Row key={finding.part + finding.says} {...finding} />)}</ul>
    </section>
  );
}

function Versions({said}: {said: Schemas['Version']}) {
  return (
    <p class="dim">
      weft {said.weft}, solver {said.solver}, libgphoto2 {said.libgphoto2}, board protocol {said.firmware_protocol}
      {said.camera && `, ${said.camera.model} ${said.camera.serial}`}
    </p>
  );
}

function drawing(): Finding {
  const part = 'drawing';
  const context = document.createElement('canvas').getContext('webgl2');
  if (!context) {
    return {part, verdict: 'warning', says: 'This browser has no WebGL 2: the daemon draws what the viewer shows, more slowly.', remedy: 'Switch on hardware acceleration in the settings of the browser.'};
  }
  const names = context.getExtension('WEBGL_debug_renderer_info');
  const renderer = String(context.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : context.RENDERER));
  context.getExtension('WEBGL_lose_context')?.loseContext();
  const isSoftware = /swiftshader|llvmpipe|software/i.test(renderer);
  return {part, verdict: 'fine', says: `WebGL 2 by ${renderer}${isSoftware ? ', without a graphics processor' : ''}.`, remedy: ''};
}

function origin(): Finding {
  const part = 'origin';
  if (isSecureContext) return {part, verdict: 'fine', says: `The page came from ${location.origin}, which the browser trusts.`, remedy: ''};
  return {part, verdict: 'warning', says: `The page came from ${location.origin} without encryption: each tab listens for itself, and copying is done the old way.`, remedy: `ssh -L ${location.port}:localhost:${location.port} ${location.hostname}`};
}

const slow_ms = 200;

function distance(roundTrip_ms: number): Finding {
  const says = `The daemon answers within ${Math.ceil(roundTrip_ms)} ms.`;
  return {part: 'distance', verdict: roundTrip_ms > slow_ms ? 'warning' : 'fine', says, remedy: roundTrip_ms > slow_ms ? 'Maps come slowly over this network: use a cable.' : ''};
}

/** What the page knows of itself: how it draws, how it came here, how far away the daemon is. */
function findingsOfPage(roundTrip_ms: number): Finding[] {
  return [drawing(), origin(), distance(roundTrip_ms)];
}

interface Examined {
  doctor: Doctor;
  page: readonly Finding[];
}

async function examine(): Promise<Examined> {
  const began = performance.now();
  await answer(api.GET('/api/v1/healthz'));
  const roundTrip_ms = performance.now() - began;
  return {doctor: await answer(api.GET('/api/v1/doctor')), page: findingsOfPage(roundTrip_ms)};
}

export default function DoctorScreen() {
  const [examined, setExamined] = useState<Examined | null>(null);
  const [complaint, complain] = useState<ApiError | null>(null);
  const [isBusy, setBusy] = useState(false);
  const again = () => {
    setBusy(true);
    complain(null);
    examine().then(setExamined, (error: unknown) => complain(asApiError(error))).finally(() => setBusy(false));
  };
  useEffect(again, []);
  return (
    <div class="page doctor">
      <div class="row">
        <h1>Doctor</h1>
        <Button isDisabled={isBusy} onClick={again}>Examine again</Button>
      </div>
      <Complaint error={complaint} />
      {examined?.doctor.leaves_alone && <p><Mark verdict="busy">Board and camera are in use and were not looked at.</Mark></p>}
      {examined && <Findings title={examined.doctor.rig} findings={examined.doctor.findings} />}
      {examined && <Findings title="This page" findings={examined.page} />}
      {examined && (
        <section class="panel">
          <h2>Solver</h2>
          <div class="row"><AskHardCases /></div>
        </section>
      )}
      {version.value && <Versions said={version.value} />}
    </div>
  );
}
