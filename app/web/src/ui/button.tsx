// SPDX-License-Identifier: Apache-2.0
import type {ComponentChildren} from 'preact';

interface ButtonProps {
  children: ComponentChildren;
  onClick?: () => void;
  /** main: what this place is for; danger: what cannot be undone. */
  kind?: 'plain' | 'main' | 'danger' | 'quiet';
  type?: 'button' | 'submit';
  isDisabled?: boolean;
  /** For a switch: whether it is on. */
  isPressed?: boolean;
  /** The key that does the same, shown in the button. */
  keyHint?: string;
  label?: string;
  id?: string;
}

export function Button({children, onClick, kind = 'plain', type = 'button', isDisabled, isPressed, keyHint, label, id}: ButtonProps) {
  return (
    <button id={id} type={type} class={`button ${kind}`} disabled={isDisabled} aria-pressed={isPressed} aria-label={label}
      aria-keyshortcuts={keyHint} onClick={onClick}>
      {children}
      {keyHint && <kbd aria-hidden="true">{keyHint}</kbd>}
    </button>
  );
}
