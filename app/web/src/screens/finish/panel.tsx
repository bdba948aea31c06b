// SPDX-License-Identifier: Apache-2.0
// Finishing: what is done to the maps of a solve step by step, with a preview of it, and all maps in the end.
import './finish.css';
import {useEffect, useMemo, useState} from 'preact/hooks';
import {answer, api} from '../../api/client';
import {go} from '../../state/address';
import {formOf} from '../../state/forms';
import {useKeys} from '../../state/keys';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {Choice} from '../../ui/choice';
import {Complaint} from '../../ui/complaint';
import {Copy} from '../../ui/copy';
import {isFields, textIn} from '../../ui/fields';
import {Mark} from '../../ui/mark';
import type {Wish} from '../../ui/request_schema';
import {More} from '../../ui/schema_form';
import {Share} from '../../ui/share';
import {cancel, jobs, queueJob, useJobs} from '../jobs/jobs';
import {errorOf} from '../jobs/price';
import {hasEnded} from '../jobs/queue';
import {addressOfViewer, FIRST_SIGHT} from '../viewer/sight';
import type {Viewer} from '../viewer/viewer';
import {StepFacts, StepPictures, Verdicts} from './found';
import {type Of, requestOf, usePreview} from './making';
import {PreviewView} from './preview_view';
import {Draft, keysOfBox, moved, type Recipe, recipeOfSet, type Recipes, type Spot, type Step, stepOf, withKeys, without} from './recipe';
import {StepForm} from './step_form';

export function FinishPanel({viewer}: {viewer: Viewer}) {
  useJobs();
  const maps = viewer.maps.value;
  const [recipes, setRecipes] = useState<Recipes | null>(null);
  const ask = useAction(async () => setRecipes(await answer(api.GET('/api/v1/recipes'))));
  useEffect(() => void ask.run(), []);
  if (viewer.name.solve === 'truth') return <section><p class="dim">The truth of a simulation is not finished.</p></section>;
  return (
    <section class="finish">
      <h2>Finish</h2>
      <Complaint error={ask.complaint} />
      {maps && recipes && <Finishing viewer={viewer} set={maps.solve.set} recipes={recipes} />}
    </section>
  );
}

interface FinishingProps {
  viewer: Viewer;
  /** The maps.json of what is looked at, where that is a set. */
  set: unknown;
  recipes: Recipes;
}

function Finishing({viewer, set, recipes}: FinishingProps) {
  const {session, solve} = viewer.name;
  const [isDraft, setIsDraft] = useState(false);
  const isPreview = viewer.maps.value?.solve.method === 'preview';
  const of = {session, solve: viewer.name.isSet ? textIn(set, 'solve') : solve, isDraft: isPreview && isDraft};
  const draft = useMemo(() => new Draft(session, recipeOfSet(set)), [session]);
  const {past, now, future} = draft.history.value;
  const preview = usePreview(of, now);
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
      <PreviewView session={session} preview={preview} />
      <Complaint error={preview.complaint ?? (preview.job?.state === 'failed' ? errorOf(preview.job) : null)} />
      <Steps viewer={viewer} recipe={now} recipes={recipes} onChange={(recipe) => draft.change(recipe)} />
      {isFields(preview.document) && (
        <>
          <Verdicts document={preview.document} />
          <StepPictures of={{session, solve: textIn(preview.document, 'id'), isSet: true}} document={preview.document} />
          <StepFacts document={preview.document} />
        </>
      )}
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

const saidHere = ['session', 'solve', 'draft', 'recipe', 'steps', 'preview'];

/** All maps, at the size of the photographs. */
function MakeAll({of, recipe}: {of: Of; recipe: Recipe}) {
  const [wish, setWish] = useState<Wish>({});
  const make = useAction(() => queueJob({...requestOf(of, recipe, false), ...wish}));
  const job = jobs.value.find(({kind, of: session}) => kind === 'maps' && session === of.session);
  const isBusy = job !== undefined && !hasEnded(job);
  const id = textIn(job?.result, 'id');
  return (
    <>
      <More of="the maps" schema={formOf('maps')} wish={wish} onWish={setWish} without={saidHere} />
      <div class="row">
        <Button kind="main" isDisabled={make.isBusy || isBusy} onClick={() => void make.run()}>Finish: make all maps</Button>
        {job?.state === 'done' && id && (
          <Button onClick={() => go(addressOfViewer({session: of.session, solve: id, isSet: true}, {...FIRST_SIGHT, panel: 'why'}))}>Look at the last ones</Button>
        )}
      </div>
      {isBusy && (
        <div class="row">
          <Mark verdict={job.held ? 'waiting' : 'busy'}>{job.phase || 'waits its turn'}</Mark>
          <Share label="Maps" share={job.share} left_s={job.left_s} />
          <Button onClick={() => void cancel(job.id)}>Cancel</Button>
        </div>
      )}
      <Complaint error={make.complaint ?? (job?.state === 'failed' ? errorOf(job) : null)} />
    </>
  );
}
