// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {type SolveReport, stagesOf} from '../../../../app/web/src/screens/viewer/why';

const least = {id: '1', method: 'standard', warnings: [], status: {}, seconds: {}, reference: null, solved_by: null} as unknown as SolveReport;

function stage(report: object, name: string) {
  const found = stagesOf({...least, ...report} as SolveReport).find((each) => each.name === name);
  if (!found) throw new Error(`no stage is called ${name}`);
  return found;
}

test('of a solve of which nothing is known only the look at its lights ran', () => {
  expect(stagesOf(least).filter(({ran}) => ran).map(({name}) => name)).toEqual(['Lights that tell nothing']);
  expect(stage({}, 'Cast shadows').says).toBe('Taken out at the level reference alone.');
});

test('what left-out light said stands beside each stage of reference', () => {
  const reference = {
    stages: ['shadows'],
    rounds: [],
    left_out: [
      {stage: 'shadows', gain: 0.012, sigma: 0.001, patches: 40, kept: true},
      {stage: 'interreflection', gain: -0.001, sigma: 0.002, patches: 40, kept: false},
    ],
  };
  expect(stage({reference}, 'Cast shadows')).toEqual({
    name: 'Cast shadows',
    ran: true,
    says: 'Taken out. With it left-out light is predicted better by 1.2 % ± 0.10 % of the brightness, over 40 patches.',
  });
  expect(stage({reference}, 'Light between yarns').ran).toBe(false);
});

test('of gloss the lobe is said, or why there is none', () => {
  expect(stage({gloss: {used: true, says: 'ggx, roughness 0.250'}}, 'Gloss')).toEqual({name: 'Gloss', ran: true, says: 'ggx, roughness 0.250.'});
  expect(stage({gloss: null}, 'Gloss')).toEqual({name: 'Gloss', ran: false, says: 'Not at this level.'});
});

test('a cloth that moved is told by LED', () => {
  const registration = [
    {led: 1, corrected: false, verdict: 'still', dx_px: 0, dy_px: 0},
    {led: 4, corrected: true, verdict: 'left out', dx_px: 3, dy_px: 4},
  ];
  expect(stage({registration}, 'Registration').says).toBe('The cloth moved and these were left out: LED 4 by 5.0 px.');
});

test('a blade\'s shadow says how sure it is', () => {
  const told = (cloth_spread: object) => stage({conditions: {cloth_spread}}, 'Light that spreads in the cloth');
  const measured = told({said: 'measured', share: 0.37, share_sigma: 0.06, mean_mm: 0.25, mean_sigma_mm: 0.04, led: 1});
  expect(measured.says).toBe('37 % ± 6.0 % left 0.25 ± 0.040 mm away, as the blade tells, and was taken off.');
  const none = told({said: 'not_observable', share: 0.02, share_sigma: 0.02, led: 1});
  expect(none).toMatchObject({ran: false, says: 'The blade shows none: 2.0 % ± 2.0 %.'});
});

test('a cloth of unknown size says in pixels how its light spreads', () => {
  const {ran, says} = stage({conditions: {cloth_spread: {said: 'told', share: 0.25, share_sigma: 0.04, mean_px: 5.2}}}, 'Light that spreads in the cloth');
  expect(ran).toBe(true);
  expect(says).toBe('25 % ± 4.0 % left 5.2 pixels away, as the cloth tells, and was taken off.');
});

test('conditions say what they corrected', () => {
  const conditions = {hot_photosites: 12, veil: 0.004, cloth_spread: {said: 'given', share: 0.3, mean_mm: 0.25}, drift: [{led: 1, factor: 0.98, from: 'repeat'}, {led: 2, factor: 1.01, from: 'repeat'}]};
  expect(stage({conditions}, 'Bad photosites').says).toBe('12 were given their neighbours\' counts.');
  expect(stage({conditions}, 'Stray light of the lens').says).toBe('0.40 % was taken off.');
  expect(stage({conditions}, 'Light that spreads in the cloth').says).toBe('30 % left 0.25 mm away, and was taken off.');
  expect(stage({conditions}, 'Drift of LEDs').says).toBe('Measured by repeated shots, 2.0 % at most.');
});
