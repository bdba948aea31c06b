// SPDX-License-Identifier: Apache-2.0
// The set that is worked on: what is to be done next, the picture, the button, and the answer to each photograph.
import type {ComponentChildren} from 'preact';
import {useEffect, useRef, useState} from 'preact/hooks';
import {asApiError, type ApiError} from '../../api/client';
import {rig} from '../../state/rig';
import {useKeys} from '../../state/keys';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {Mark} from '../../ui/mark';
import {digits} from '../../ui/say';
import {Share} from '../../ui/share';
import {leaveOut, photograph} from './calibrations';
import {CoverageMap} from './coverage';
import {FinderView} from './finder_view';
import {Answer, Photographs} from './photographs';
import {
  coverageOf, figuresOf, isMet, lastUsed, outlineFound, outlineWanted, shareOf, takenBy, type CameraFigure, type PhotographSet,
} from './photograph_set';

interface Choice {
  name: string;
  out: boolean;
}

interface SetPanelProps {
  set: PhotographSet;
  /** What the photographs by now would give. */
  soFar: ComponentChildren;
  /** What can be made of the photographs that there are. */
  children?: ComponentChildren;
}

export function SetPanel({set, soFar, children}: SetPanelProps) {
  const [complaint, complain] = useState<ApiError | null>(null);
  const {answered, begin} = useAnswer(set);
  const choices = useRef<Choice[]>([]);
  const doing = (act: () => Promise<void>) => {
    complain(null);
    act().catch((error: unknown) => complain(asApiError(error)));
  };
  const canTake = set.next !== null && !set.busy;
  const take = () => {
    if (!canTake || !set.next) return;
    begin(set.next.name);
    doing(photograph);
  };
  const choose = (name: string, out: boolean) => doing(async () => {
    await leaveOut(name, out);
    choices.current.push({name, out});
  });
  /** The last choice is taken back; where there was none, the last photograph that counts is left out. */
  const undo = () => doing(async () => {
    const last = choices.current.pop();
    const name = last?.name ?? lastUsed(set)?.name;
    if (name !== undefined) await leaveOut(name, last ? !last.out : true);
  });
  useKeys('calibrate', [
    {key: 'Space', does: 'take the photograph', run: take},
    {key: 'Ctrl+z', does: 'undo leaving out, or leave the last one out', run: undo},
  ]);
  const coverage = coverageOf(set);
  return (
    <div class="set">
      <div class="doing">
        <p class="says" role="status">{set.next?.says ?? 'All photographs that are needed are there.'}</p>
        <FinderView wanted={outlineWanted(set)} found={outlineFound(set)} />
        <div class="row">
          <Button kind="main" isDisabled={!canTake} onClick={take} keyHint="Space">Take it</Button>
          <Button kind="quiet" isDisabled={set.busy || set.photographs.length === 0} onClick={undo} keyHint="Ctrl+z">Undo</Button>
          {set.busy && <Progress />}
          {answered !== null && !set.error && <StepAnswer set={set} step={answered} />}
        </div>
        <Complaint error={complaint ?? set.error} />
        {children}
      </div>
      <div class="known">
        <Figures figures={figuresOf(set)} />
        {coverage && <CoverageMap coverage={coverage} />}
        {soFar}
        <h3>Photographs <span class="count">{set.photographs.length}</span></h3>
        <Photographs set={set} onLeaveOut={choose} />
      </div>
    </div>
  );
}

/** The step that was photographed last, once its photograph was judged. */
function useAnswer(set: PhotographSet) {
  const [asked, ask] = useState<string | null>(null);
  const [answered, answer] = useState<string | null>(null);
  const wasBusy = useRef(set.busy);
  useEffect(() => {
    if (wasBusy.current && !set.busy) answer(asked);
    wasBusy.current = set.busy;
  }, [set.busy]);
  const begin = (step: string) => {
    ask(step);
    answer(null);
  };
  return {answered, begin};
}

function StepAnswer({set, step}: {set: PhotographSet; step: string}) {
  const taken = takenBy(set, step);
  return (
    <p class="answer" role="status">
      <strong>{taken?.name ?? step}</strong> {taken ? <Answer photograph={taken} /> : <Mark verdict="fine">taken</Mark>}
    </p>
  );
}

function Progress() {
  const status = rig.value;
  const share = status && status.frames_planned > 0 ? status.frames / status.frames_planned : null;
  return <Share label="Photographs" share={share} left_s={status?.left_s} />;
}

/** How well the camera is known by now, against what is asked. */
function Figures({figures}: {figures: readonly CameraFigure[]}) {
  return (
    <dl class="figures">
      {figures.map((figure) => (
        <div key={figure.key}>
          <dt>{figure.name}</dt>
          <dd>
            <span class="numbers" data-figure={figure.key}>
              <Mark verdict={isMet(figure) ? 'fine' : 'waiting'}>{digits(figure.now, 3)} {figure.unit}</Mark>
            </span>
            <progress aria-label={`${figure.name} on the way to what is asked`} value={shareOf(figure)} max={1} />
            <span class="dim numbers">
              asked {digits(figure.asked)} {figure.unit}
              {figure.then !== null && `, next ${digits(figure.then)}`}
            </span>
          </dd>
        </div>
      ))}
    </dl>
  );
}
