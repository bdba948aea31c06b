// SPDX-License-Identifier: Apache-2.0
import './report.css';
import {render} from 'preact';
import {Report} from './report';

const data = document.querySelector('#report');
const main = document.querySelector('main');
if (data?.textContent && main) {
  main.replaceChildren();
  render(<Report {...JSON.parse(data.textContent)} />, main);
}
