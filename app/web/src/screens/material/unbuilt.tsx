// SPDX-License-Identifier: Apache-2.0
import {useEffect, useState} from 'preact/hooks';
import {answer, api, type ApiError, asApiError, type Schemas} from '../../api/client';
import {Complaint} from '../../ui/complaint';
import {timeOf} from '../../ui/words';
import {LayersPanel} from './layers_panel';
import {placeOfMaterial} from './sight';

/** A material by its files, with what was built of it. */
export function Unbuilt({material}: {material: string}) {
  const [builds, setBuilds] = useState<Schemas['Builds']['builds']>([]);
  const [complaint, setComplaint] = useState<ApiError | null>(null);
  useEffect(() => {
    answer(api.GET('/api/v1/materials/{name}/builds', {params: {path: {name: material}}})).then(
      (list) => setBuilds(list.builds), (error: unknown) => setComplaint(asApiError(error)),
    );
  }, [material]);
  return (
    <section class="page material-files">
      <h1>{material}</h1>
      <Complaint error={complaint} />
      <LayersPanel material={material} built="" />
      <h2>Builds</h2>
      {builds.length === 0 && <p class="dim">None yet.</p>}
      <ul class="choose-material" aria-label="Builds">
        {builds.map(({id, created}) => <li key={id}><a href={placeOfMaterial({of: material, is: 'builds', id})}>{id.slice(0, 8)}</a> <span class="dim">{timeOf(created)}</span></li>)}
      </ul>
    </section>
  );
}
