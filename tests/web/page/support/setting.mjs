// SPDX-License-Identifier: Apache-2.0
// What most files of tests need: one browser and one rig.
import {launch} from './browser.mjs';
import {startRig} from './rig.mjs';

/** `options` as of startRig, `flags` as of launch. */
export async function setUp(options, ...flags) {
  const rig = await startRig(options);
  return {rig, browser: await launch(...flags)};
}

export async function takeDown(browser, rig) {
  await browser?.close();
  await rig?.stop();
}
