// SPDX-License-Identifier: Apache-2.0
// Finishing: what is done to the maps of a solve step by step, with a preview of it, and all maps in the end.
import './finish.css';
import {useEffect, useMemo, useRef, useState} from 'preact/hooks';
import {answer, api, asApiError, type Schemas} from '../../api/client';
import type {Repeat} from '../../gl/tiles';
import {go} from '../../state/address';
import {formOf} from '../../state/forms';
import {useKeys} from '../../state/keys';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {Choice} from '../../ui/choice';
import {Complaint} from '../../ui/complaint';
import {Copy} from '../../ui/copy';
import {fieldsOf, listIn, numberIn, textIn} from '../../ui/fields';
import {Mark} from '../../ui/mark';
import {Offers} from '../../ui/offers';
import {type Wish, wordsOf} from '../../ui/request_schema';
import {degrees, digits} from '../../ui/say';
import {More} from '../../ui/schema_form';
import {Share} from '../../ui/share';
import {durationOf} from '../../ui/words';
import {cancel, jobs, queueJob, useJobs} from '../jobs/jobs';
import {errorOf} from '../jobs/price';
import {hasEnded, type Job} from '../jobs/queue';
import type {Maps} from '../viewer/maps';
import {addressOfViewer, FIRST_SIGHT, type SolveName, textOf} from '../viewer/sight';
import type {Viewer} from '../viewer/viewer';
import {StepFacts, StepPictures, Verdicts} from './found';
import {jobWith, type Of, requestOf, usePreview} from './making';
import {Draft, keysOfBox, moved, type Recipe, recipeOfSet, type Recipes, type Spot, type Step, stepOf, withKeys, without} from './recipe';
import {StepForm} from './step_form';

export function FinishPanel({viewer}: {viewer: Viewer}) {
  useJobs();
  // The panel stays as it is while what it made is fetched.
  const last = useRef<Maps | null>(null);
  const maps = (last.current = viewer.maps.value ?? last.current);
  const [recipes, setRecipes] = useState<Recipes | null>(null);
  const ask = useAction(async () => setRecipes(await answer(api.GET('/api/v1/recipes'))));
  useEffect(() => void ask.run(), []);
  if (viewer.name.solve === 'truth') return <section><p class="dim">The truth of a simulation is not finished.</p></section>;
  return (
    <section class="finish">
      <h2>Finish</h2>
      <Complaint error={ask.complaint} />
      {maps && recipes && <Finishing viewer={viewer} maps={maps} recipes={recipes} />}
    </section>
  );
}

interface FinishingProps {
  viewer: Viewer;
  /** What is looked at. */
  maps: Maps;
  recipes: Recipes;
}

function Finishing({viewer, maps: {name, solve: {method, set, width, height}}, recipes}: FinishingProps) {
  const {session} = name;
  const [isDraft, setIsDraft] = useState(false);
  const isPreview = method === 'preview';
  const of = {session, solve: name.isSet ? textIn(set, 'solve') : name.solve, isDraft: isPreview && isDraft};
  const draft = useMemo(() => new Draft(session, recipeOfSet(set)), [session]);
  const {past, now, future} = draft.history.value;
  const preview = usePreview(of, now);
  const {job, document} = preview;
  const [across, down, ofAcross, ofDown] = listIn(document, 'part_mm').map((mm) => Number(mm).toFixed());
  const [kept] = useState(now);
  const made = textIn(document, 'id');
  const facts = fieldsOf(document);
  const isLooking = fieldsOf(set)['preview'] === true;
  const look: SolveName | null = now.length === 0 ? isLooking ? {session, solve: of.solve} : null : made ? {session, solve: made, isSet: true} : null;
  const lookThere = () => {
    const sight = viewer.sight.value;
    const {light, layer, repeat} = sight;
    const isSameSize = facts['width'] === width && facts['height'] === height;
    if (look) go(addressOfViewer(look, {
      ...(isSameSize ? sight : FIRST_SIGHT), light, layer, panel: 'finish',
      divider: isLooking ? sight.divider : 0.5,
      repeat: facts['is_tile'] ? Math.max(2, repeat) as Repeat : 1,
    }), isLooking);
  };
  // What is made of a change is looked at; nobody is led away from what he came for.
  useEffect(() => {
    if (isLooking || now !== kept) lookThere();
  }, [look && textOf(look)]);
  useKeys('viewer', [
    {key: 'Ctrl+z', does: 'undo a change of the recipe', run: () => draft.undo()},
    {key: 'Ctrl+y', does: 'redo it', run: () => draft.redo()},
    {key: 'Ctrl+Shift+z', does: 'redo it', run: () => draft.redo()},
  ]);
  return (
    <>
      {isPreview && (
        <label>
          <input type="checkbox" checked={isDraft} onChange={(event) => setIsDraft(event.currentTarget.checked)} />
          {' '}A draft: this solve is a preview, of half the size and without masks
        </label>
      )}
      <div class="row">
        {recipes.recipes.map(({name, steps}) => <Button key={name} label={`Recipe ${name}`} onClick={() => draft.change(steps)}>{name}</Button>)}
      </div>
      <div class="row">
        <Button kind="quiet" keyHint="Ctrl+z" isDisabled={past.length === 0} onClick={() => draft.undo()}>Undo</Button>
        <Button kind="quiet" keyHint="Ctrl+y" isDisabled={future.length === 0} onClick={() => draft.redo()}>Redo</Button>
      </div>
      {job && <Progress label="Preview" job={job} />}
      {across && <p>Preview of the middle: {across} × {down} of {ofAcross} × {ofDown} mm</p>}
      {made && !isLooking && <Button onClick={lookThere}>Look at the preview</Button>}
      <Complaint error={preview.complaint ?? (job?.state === 'failed' ? errorOf(job) : null)} />
      <Steps viewer={viewer} recipe={now} recipes={recipes} onChange={(recipe) => draft.change(recipe)} />
      {made && (
        <>
          <Verdicts document={document} />
          <StepPictures of={{session, solve: made, isSet: true}} document={document} />
          <StepFacts document={document} />
        </>
      )}
      <ClothKind viewer={viewer} />
      <MakeAll of={of} recipe={now} />
    </>
  );
}

interface StepsProps {
  viewer: Viewer;
  recipe: Recipe;
  recipes: Recipes;
  onChange: (recipe: Recipe) => void;
}

function Steps({viewer, recipe, recipes, onChange}: StepsProps) {
  const [added, setAdded] = useState(recipes.steps[0]?.name ?? '');
  const kindOf = (name: string) => recipes.steps.find((kind) => kind.name === name);
  const {box} = viewer.sight.value;
  const mm = viewer.name.isSet ? viewer.maps.value?.solve.mm_per_pixel : null;
  const fromBox = (step: Step) => (box && mm ? keysOfBox(step.do, box, mm, (step['spots'] ?? []) as Spot[]) : null);
  const add = () => {
    const kind = kindOf(added);
    if (kind) onChange([...recipe, stepOf(kind)]);
  };
  return (
    <>
      <ol class="steps" aria-label="Steps">
        {recipe.map((step, index) => (
          <StepForm key={index} index={index} step={step} kind={kindOf(step.do)} isFirst={index === 0} isLast={index === recipe.length - 1}
            fromBox={fromBox(step)} onKeys={(keys) => onChange(withKeys(recipe, index, keys))}
            onMove={(by) => onChange(moved(recipe, index, by))} onRemove={() => onChange(without(recipe, index))} />
        ))}
      </ol>
      {recipe.length === 0 && <p class="dim">No step: the maps are as they were photographed.</p>}
      <div class="row add">
        <Choice label="Step to add" value={added} options={recipes.steps.map(({name}) => ({value: name, says: name}))} onChange={setAdded} />
        <Button onClick={add}>Add</Button>
        <Copy text={JSON.stringify({steps: recipe})} what="Copy the recipe" />
      </div>
    </>
  );
}

const saidHere = ['session', 'solve', 'draft', 'recipe', 'steps', 'preview', 'cloth'];

/** What the cloth is, which maps take for what its photographs do not tell: asked once, and kept with the session. */
function ClothKind({viewer}: {viewer: Viewer}) {
  const params = {path: {name: viewer.name.session}};
  const [kind, setKind] = useState('');
  const complain = (error: unknown) => (viewer.complaint.value = asApiError(error));
  useEffect(() => {
    answer(api.GET('/api/v1/sessions/{name}', {params})).then(({said}) => setKind(textIn(said, 'kind')), complain);
  }, []);
  const say = (to: string) => {
    setKind(to);
    answer(api.PATCH('/api/v1/sessions/{name}/metadata', {params, body: {kind: to || null}})).catch(complain);
  };
  const kinds = wordsOf(formOf('maps'), 'cloth').map((value) => ({value, says: value}));
  return <Choice label="What kind of cloth is it?" value={kind} options={[{value: '', says: 'not said'}, ...kinds]} onChange={say} />;
}

function Progress({label, job}: {label: string; job: Job}) {
  if (hasEnded(job)) return null;
  return (
    <div class="row">
      <Mark verdict={job.held ? 'waiting' : 'busy'}>{job.phase || 'waits its turn'}</Mark>
      <Share label={label} share={job.share} left_s={job.left_s} />
      <Button onClick={() => void cancel(job.id)}>Cancel</Button>
    </div>
  );
}

interface GridsProps {
  of: Of;
  recipe: Recipe;
  taken_mm: number | null;
  onTake: (mm: number | null) => void;
}

/** What the recipe takes on coarser grids, and what they lose: asked for by a click. */
function Grids({of, recipe, taken_mm, onTake}: GridsProps) {
  const [id, setId] = useState('');
  const price = useAction(async () => setId((await queueJob({...requestOf(of, recipe, false), kind: 'finish_price'} as Schemas['FinishPriceJob'])).id));
  const job = jobWith(id);
  const rows = listIn(job?.result, 'rows').map((row) => ({
    mm: numberIn(row, 'mm_per_pixel') ?? 0, size: `${numberIn(row, 'width')} × ${numberIn(row, 'height')}`,
    seconds: numberIn(row, 'seconds') ?? 0, lost_deg: numberIn(row, 'lost_deg') ?? 0, isBest: fieldsOf(row)['chosen'] === true,
  }));
  return (
    <>
      {rows.length === 0 && <Button kind="quiet" isDisabled={price.isBusy || (job !== null && !hasEnded(job))} onClick={() => void price.run()}>What each grid costs</Button>}
      {job && !hasEnded(job) && <Progress label="Grids" job={job} />}
      <Complaint error={price.complaint ?? (job?.state === 'failed' ? errorOf(job) : null)} />
      <Offers label="Grids" offers={rows.map(({mm, size, seconds, lost_deg, isBest}) => ({
        says: `${digits(mm, 3)} mm a pixel, ${size}`, figures: `${degrees(lost_deg)} lost, ${durationOf(seconds)}`, isBest,
        isTaken: mm === taken_mm, take: () => onTake(mm === taken_mm ? null : mm),
      }))} />
    </>
  );
}

/** All maps, at the size of the photographs. */
function MakeAll({of, recipe}: {of: Of; recipe: Recipe}) {
  const [wish, setWish] = useState<Wish>({});
  const [begun, setBegun] = useState('');
  const [grid_mm, setGrid] = useState<number | null>(null);
  const make = useAction(async () => setBegun((await queueJob({...requestOf(of, recipe, false), ...wish, ...(grid_mm && {mm_per_pixel: grid_mm})})).id));
  const job = jobs.value.find(({kind, of: session}) => kind === 'maps' && session === of.session);
  const isBusy = job !== undefined && !hasEnded(job);
  const made = job?.id === begun && job.state === 'done' ? job.result : null;
  useEffect(() => {
    const repeat = fieldsOf(made)['is_tile'] === true ? 2 : 1;
    if (made) go(addressOfViewer({session: of.session, solve: textIn(made, 'id'), isSet: true}, {...FIRST_SIGHT, panel: 'why', repeat}));
  }, [made]);
  return (
    <>
      <More of="the maps" schema={formOf('maps')} wish={wish} onWish={setWish} without={grid_mm ? [...saidHere, 'mm_per_pixel'] : saidHere} />
      <Grids key={JSON.stringify([of, recipe])} of={of} recipe={recipe} taken_mm={grid_mm} onTake={setGrid} />
      <div class="row">
        <Button kind="main" isDisabled={make.isBusy || isBusy} onClick={() => void make.run()}>Finish: make all maps</Button>
      </div>
      {job && <Progress label="Maps" job={job} />}
      <Complaint error={make.complaint ?? (job?.state === 'failed' ? errorOf(job) : null)} />
    </>
  );
}
