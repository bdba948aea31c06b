// SPDX-License-Identifier: Apache-2.0
// How a person likes the desk.
import {kept} from '../../state/kept';

export const showsGrid = kept<boolean>('grid', true);
export const showsEdges = kept<boolean>('edges', false);
/** Turns the picture, for who sits on the other side. */
export const turn = kept<'0' | '180'>('turn', '0');

/** Whether a scan takes the first LED and the dark once more at its end. */
export const repeats = kept<boolean>('repeat', true);
/** A scan takes each LED once more at so many times the exposure; empty: it does not. */
export const bracket = kept<string>('bracket', '');
/** A scan takes this LED once more with a blade above the cloth; empty: it does not. */
export const blade = kept<string>('blade', '');
