// SPDX-License-Identifier: Apache-2.0
// What the recipe makes of the maps, small, beside them: a tile twice a side, so that its seam is seen.
import {useState} from 'preact/hooks';
import {Choice} from '../../ui/choice';
import {textIn} from '../../ui/fields';
import {Mark} from '../../ui/mark';
import {Share} from '../../ui/share';
import {hasEnded} from '../jobs/queue';
import {addressOfMaps} from '../viewer/maps';
import {addressOfViewer, FIRST_SIGHT} from '../viewer/sight';
import type {Preview} from './making';

const looks = [
  {value: 'relit', says: 'Relit', form: 'jpg'},
  {value: 'albedo', says: 'Albedo', form: 'jpg'},
  {value: 'normal', says: 'Normals', form: 'png'},
] as const;

export function PreviewView({session, preview: {job, document}}: {session: string; preview: Preview}) {
  const [look, setLook] = useState<(typeof looks)[number]['value']>('relit');
  const id = textIn(document, 'id');
  const isTile = (document as {is_tile?: boolean} | null)?.is_tile === true;
  const name = {session, solve: id, isSet: true} as const;
  const form = looks.find(({value}) => value === look)?.form ?? 'jpg';
  const count = isTile ? 4 : 1;
  return (
    <div class="preview" aria-busy={job !== null && !hasEnded(job)}>
      {job && !hasEnded(job) && <Mark verdict={job.held ? 'waiting' : 'busy'}>{job.phase || 'waits its turn'} <Share label="Preview" share={job.share} left_s={job.left_s} /></Mark>}
      {id && (
        <>
          <div class={isTile ? 'tiles twice' : 'tiles'}>
            {Array.from({length: count}, (_, index) => (
              <img key={index} alt={index === 0 ? `Preview, ${look}` : ''} src={`${addressOfMaps(name)}/tiles/${look}/top/0_0.${form}`} />
            ))}
          </div>
          <div class="row">
            <Choice label="Preview of" value={look} options={looks} onChange={setLook} />
            <a href={addressOfViewer(name, {...FIRST_SIGHT, panel: 'finish', repeat: isTile ? 2 : 1})}>Look at the preview</a>
          </div>
        </>
      )}
    </div>
  );
}
