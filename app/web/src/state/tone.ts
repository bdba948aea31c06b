// SPDX-License-Identifier: Apache-2.0
// The end of a scan, heard.
import {kept} from './kept';

/** Whether it is wanted. */
export const hasTone = kept<boolean>('tone', true);

const tone_s = 0.4;

/** For who looks elsewhere: low, and once. A browser lets no page be heard that nobody has touched. */
export function sound(): void {
  if (!hasTone.value || document.hidden || !navigator.userActivation.hasBeenActive) return;
  const audio = new AudioContext();
  const tone = new OscillatorNode(audio, {frequency: 660});
  const volume = new GainNode(audio, {gain: 0.05});
  const end = audio.currentTime + tone_s;
  volume.gain.exponentialRampToValueAtTime(0.001, end);
  tone.connect(volume).connect(audio.destination);
  tone.onended = () => void audio.close();
  tone.start();
  tone.stop(end);
}
