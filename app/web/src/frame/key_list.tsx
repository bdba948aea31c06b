// SPDX-License-Identifier: Apache-2.0
import {registry} from '../state/keys';
import {Dialog} from '../ui/dialog';

export function KeyList({onClose}: {onClose: () => void}) {
  return (
    <Dialog title="Keys" onClose={onClose}>
      {[...registry.value].map(([screen, keys]) => (
        <section key={screen}>
          <h3>{screen}</h3>
          <dl class="keys">
            {keys.map(({key, does}) => (
              <div key={key}>
                <dt><kbd>{key}</kbd></dt>
                <dd>{does}</dd>
              </div>
            ))}
          </dl>
        </section>
      ))}
      <form method="dialog"><button class="button">Close</button></form>
    </Dialog>
  );
}
