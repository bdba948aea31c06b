// SPDX-License-Identifier: Apache-2.0
import {describe, expect, test} from 'vitest';
import {isWrong, keptBy, labelOf, rangeInWords, schemaOf, type SchemaField, valueOf, withValue, wordsOf} from '../../../../app/web/src/ui/request_schema';

const schema = schemaOf({
  required: ['kind', 'session'],
  properties: {
    kind: {type: 'string', enum: ['weave']},
    session: {type: 'string', 'x-names': 'session', description: 'What is woven'},
    flatness_deg: {type: 'number', minimum: 0, maximum: 2, default: 0.3},
    threads: {type: 'integer', exclusiveMinimum: 0},
    leds: {type: 'array', items: {type: 'integer', minimum: 1}},
    maps: {type: 'array', items: {type: 'string', enum: ['height', 'cavity']}},
    calibration: {oneOf: [{type: 'string', 'x-names': 'folder'}, {type: 'array', items: {type: 'string'}}]},
    weave: {type: 'string', enum: ['plain', 'twill'], default: 'plain'},
    previews: {type: 'boolean', default: true},
    steps: {type: 'object'},
  },
  allOf: [{not: {required: ['threads', 'weave']}}, {anyOf: [{required: ['session']}]}],
});

function field(name: string): SchemaField {
  const found = schema.fields.find((each) => each.name === name);
  if (!found) throw new Error(`there is no field ${name}`);
  return found;
}

describe('a form', () => {
  test('has a line for each field that can be typed, in their order', () => {
    expect(schema.fields.map(({name, holds}) => `${name} ${holds}`)).toEqual([
      'session text', 'flatness_deg number', 'threads whole', 'leds numbers', 'maps words', 'calibration text', 'weave word', 'previews flag',
    ]);
    expect(field('session')).toMatchObject({says: 'What is woven', names: 'session', isNeeded: true});
    expect(field('calibration').names).toBe('folder');
    expect(field('weave').otherwise).toBe('plain');
    expect(wordsOf(schema, 'weave')).toEqual(['plain', 'twill']);
  });

  test('calls a field by its name and says its unit', () => {
    expect(labelOf(field('flatness_deg'))).toEqual({label: 'Flatness', unit: '°'});
    expect(labelOf({name: 'mm_per_pixel'})).toEqual({label: 'Mm per pixel', unit: ''});
    expect(labelOf({name: 'within_s'})).toEqual({label: 'Within', unit: 's'});
  });

  test('says the range and finds what is out of it', () => {
    expect(['flatness_deg', 'threads', 'leds', 'weave'].map((name) => rangeInWords(field(name)))).toEqual(['0 to 2', 'above 0', 'at least 1', '']);
    expect(isWrong(field('flatness_deg'), 2)).toBe(false);
    expect(isWrong(field('flatness_deg'), 2.1)).toBe(true);
    expect(isWrong(field('flatness_deg'), 'many')).toBe(true);
    expect(isWrong(field('threads'), 0)).toBe(true);
    expect(isWrong(field('threads'), 1.5)).toBe(true);
    expect(isWrong(field('leds'), [1, 0])).toBe(true);
    expect(isWrong(field('leds'), undefined)).toBe(false);
  });

  test('takes what was typed as the request says it', () => {
    expect(valueOf(field('flatness_deg'), ' 0.5 ')).toBe(0.5);
    expect(valueOf(field('flatness_deg'), '0,5')).toBe('0,5');
    expect(valueOf(field('flatness_deg'), ' ')).toBeNull();
    expect(valueOf(field('leds'), '1, 4,7')).toEqual([1, 4, 7]);
    expect(valueOf(field('maps'), 'height, cavity')).toEqual(['height', 'cavity']);
    expect(withValue({threads: 3}, 'threads', null)).toEqual({});
    expect(withValue({threads: 3}, 'weave', 'twill')).toEqual({threads: 3, weave: 'twill'});
  });

  test('keeps fields apart that exclude each other', () => {
    expect(keptBy(schema, 'weave', ['threads'])).toBe('threads');
    expect(keptBy(schema, 'threads', ['weave'])).toBe('weave');
    expect(keptBy(schema, 'previews', ['threads', 'weave'])).toBeNull();
  });
});
