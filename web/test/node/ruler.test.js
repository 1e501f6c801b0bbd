// SPDX-License-Identifier: Apache-2.0
// Lengths as people read them: round ones for the bar of scale, three digits and a unit for what is measured.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { lengthText, roundLength } from '../../viewer/ruler.js';
import { readOptions } from '../../viewer/options.js';

test('the bar of scale is 1, 2 or 5 of a power of ten, and never longer than asked for', () => {
  for (const [most, length] of [[1, 1], [1.9, 1], [2, 2], [4.99, 2], [5, 5], [9.99, 5], [0.03, 0.02], [730, 500], [1e-4, 1e-4]])
    assert.ok(Math.abs(roundLength(most) - length) < 1e-9 * length, `${most}`);
  for (let most = 1e-6; most < 1e6; most *= 1.37) {
    assert.ok(roundLength(most) <= most * (1 + 1e-12), `${most}`);
    assert.ok(roundLength(most) > most / 2.51, `${most}`);
  }
});

test('a length has three digits and the unit that it is read in', () => {
  for (const [metres, text] of [[1234, '1.23 km'], [12.344, '12.3 m'], [1, '1 m'], [0.9999, '1 m'], [0.123, '12.3 cm'], [0.0042, '4.2 mm'], [2e-5, '0.02 mm']])
    assert.equal(lengthText(metres, 1), text);
  assert.equal(lengthText(50, 0.01), '50 cm');
  assert.equal(lengthText(0.1234, 0), '0.123 units');
  assert.equal(lengthText(0.5, 1, 'de'), '50 cm');
  assert.equal(lengthText(1.5, 1, 'de'), '1,5 m');
});

test('metres of a unit are a number above 0, and a scale that is switched off stays off', () => {
  const of = (text, page) => readOptions(new URLSearchParams(text), page);
  assert.equal(of('metres=0.01').metres, 0.01);
  for (const none of ['', 'metres=', 'metres=-1', 'metres=two', 'metres=NaN']) assert.equal(of(none).metres, 0, none);
  assert.equal(of('', { metres: 0.5 }).metres, 0.5);
  assert.deepEqual(['', 'scale=0', 'scale=1'].map((text) => of(text).scale), [true, false, true]);
});
