// SPDX-License-Identifier: Apache-2.0
import './sessions.css';
import {place} from '../../state/address';
import {Library} from './library';
import {SessionPage} from './session_page';

export default function SessionsScreen() {
  const [name] = place.value.parts;
  return name === undefined ? <Library /> : <SessionPage key={name} name={name} />;
}
