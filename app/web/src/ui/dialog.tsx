// SPDX-License-Identifier: Apache-2.0
import type {ComponentChildren, TargetedKeyboardEvent} from 'preact';
import {useEffect, useRef} from 'preact/hooks';

interface DialogProps {
  title: string;
  onClose: () => void;
  children: ComponentChildren;
}

/** Keys are the dialog's own while it is open; one that is pressed while it goes away is the page's again. */
function keepKeys(event: TargetedKeyboardEvent<HTMLDialogElement>): void {
  if (event.currentTarget.open) event.stopPropagation();
}

/** A question or a list before everything else; Escape closes it and the focus goes back. */
export function Dialog({title, onClose, children}: DialogProps) {
  const dialog = useRef<HTMLDialogElement>(null);
  useEffect(() => {
    dialog.current?.showModal();
    dialog.current?.scrollTo(0, 0);  // it is scrolled to what has the focus
  }, []);
  return (
    <dialog ref={dialog} aria-labelledby="dialog-title" onClose={onClose} onKeyDown={keepKeys}>
      <h2 id="dialog-title">{title}</h2>
      {children}
    </dialog>
  );
}
