// SPDX-License-Identifier: Apache-2.0
import {clothOf} from '../../state/cloths';
import type {MaterialName} from './material_sight';

/** What people call it: the cloth of a scan, the name of a material. */
export function titleOf({of, is}: MaterialName): string {
  return is === 'maps' ? clothOf(of) : of;
}
