// SPDX-License-Identifier: Apache-2.0
import {describe, expect, test} from 'vitest';
import {lightPlanOf, signed} from '../../../../app/web/src/screens/calibrate/light_plan';

const row = (name: string, sigma: object, more: object = {}) => ({
  name, what: `${name} of it`, sigma, least_sigma: {}, observable: false, unsolved_share: 0, extra_shots: 0, extra_seconds: 0, degrees_won: 0, ...more,
});

describe('a plan of lights', () => {
  test('has its rows, with null for what is not told', () => {
    const plan = lightPlanOf({
      rig: 'north', leds: 10, cloth: {name: 'velvet', sheen: 0.05}, verdict: 'it shows', notes: ['ten'],
      rows: [
        row('as-it-is', {normal_deg: null, alpha: null, sheen: null, correlation: -1}, {degrees_won: null}),
        row('polarisers', {normal_deg: 0.733, alpha: 0.0079, sheen: 0.0007, correlation: 0}, {observable: true, extra_shots: 10, extra_seconds: 70, degrees_won: -0.083}),
      ],
    });
    expect(plan?.strength).toBe('sheen');
    expect(plan?.rows).toEqual([
      {name: 'as-it-is', what: 'as-it-is of it', normal_deg: null, alpha: null, strength: null, isObservable: false, shots: 0, seconds: 0, won_deg: null},
      {name: 'polarisers', what: 'polarisers of it', normal_deg: 0.733, alpha: 0.0079, strength: 0.0007, isObservable: true, shots: 10, seconds: 70, won_deg: -0.083},
    ]);
  });

  test('of a matt cloth has no lobe, and what is no plan is none', () => {
    expect(lightPlanOf({cloth: {name: 'cotton'}, rows: [row('as-it-is', {normal_deg: 1})]})?.strength).toBe('');
    expect(lightPlanOf(null)).toBeNull();
    expect(lightPlanOf({rows: []})).toBeNull();
  });
});

test('what is won has its sign, and nothing has none', () => {
  expect([0.0131, -0.0829, 0, -0.0001, null].map((value) => signed(value, 3))).toEqual(['+0.013', '-0.083', '0.000', '0.000', '-']);
  expect(signed(10)).toBe('+10');
});
