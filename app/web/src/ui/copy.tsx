// SPDX-License-Identifier: Apache-2.0
import {useState} from 'preact/hooks';
import {Button} from './button';

/** A page that came by plain http from another machine has no clipboard but this old way. */
function copyBySelection(text: string): boolean {
  const field = document.createElement('textarea');
  field.value = text;
  field.className = 'unseen';
  document.body.append(field);
  field.select();
  const isCopied = document.execCommand('copy');
  field.remove();
  return isCopied;
}

async function copy(text: string): Promise<boolean> {
  const clipboard = navigator.clipboard as Clipboard | undefined;
  if (!clipboard) return copyBySelection(text);
  return clipboard.writeText(text).then(() => true, () => copyBySelection(text));
}

/** A button that copies, and says whether it did. */
export function Copy({text, what = 'Copy'}: {text: string; what?: string}) {
  const [said, say] = useState(what);
  return (
    <Button kind="quiet" onClick={async () => say((await copy(text)) ? 'Copied' : 'Select it and press Ctrl+C')}>
      {said}
    </Button>
  );
}
