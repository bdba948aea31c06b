// SPDX-License-Identifier: Apache-2.0
// What becomes different once the rig scans by another calibration, and the button that has it do so.
import {useEffect, useState} from 'preact/hooks';
import {asApiError, type ApiError} from '../../api/client';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {Mark} from '../../ui/mark';
import {accept, askCalibrations, calibrations} from './calibrations';

type Change = Awaited<ReturnType<typeof accept>>;

export function Acceptance({folder}: {folder: string}) {
  const isRigs = calibrations.value.some((each) => each.is_rigs && each.folder === folder);
  const [change, setChange] = useState<Change | null>(null);
  const [complaint, complain] = useState<ApiError | null>(null);
  const make = useAction(async () => {
    await accept(folder, true);
    await askCalibrations();
  });
  useEffect(() => {
    if (isRigs) return;
    accept(folder, false).then(setChange, (error: unknown) => complain(asApiError(error)));
  }, [folder, isRigs]);
  if (isRigs) return <p role="status"><Mark verdict="fine">The rig scans by {folder}.</Mark></p>;
  return (
    <section class="panel acceptance" aria-labelledby="acceptance-title">
      <h2 id="acceptance-title">What accepting {folder} changes</h2>
      <Complaint error={complaint} />
      {change && (
        <>
          <ul>{change.words.map((line) => <li key={line}>{line}</li>)}</ul>
          {change.warning && <p><Mark verdict="warning">{change.warning}</Mark></p>}
          <div><Button kind="main" isDisabled={make.isBusy} onClick={() => void make.run()}>Make it the rig's</Button></div>
        </>
      )}
      <Complaint error={make.complaint} />
    </section>
  );
}
