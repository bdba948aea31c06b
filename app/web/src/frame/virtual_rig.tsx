// SPDX-License-Identifier: Apache-2.0
// Of a rig that is not there: a key for the panel that breaks it.
import type {ComponentType} from 'preact';
import {useState} from 'preact/hooks';
import {everywhere, useKeys} from '../state/keys';

export function VirtualRig() {
  const [panel, setPanel] = useState<{Panel: ComponentType} | null>(null);
  const toggle = async () => {
    const {VirtualPanel} = await import('./virtual_panel');
    setPanel(panel ? null : {Panel: VirtualPanel});
  };
  useKeys(everywhere, [{key: 'V', does: 'break this virtual rig, lay its table', run: () => void toggle()}]);
  return panel && <panel.Panel />;
}
