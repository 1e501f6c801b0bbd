// SPDX-License-Identifier: Apache-2.0
// What views of a whole light field frame.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { boundingBall } from '../../viewer/packed_field.js';

test('a few points far away are not framed, but within reach', () => {
  const positions = new Int32Array(3 * 604).map((_, i) => (i < 1800 ? 1000 + ((i * 7919) % 64) : (i % 2) * 60000));
  const all = boundingBall({ positions }),
    object = boundingBall({ positions: positions.subarray(0, 1800) });
  assert.deepEqual(all.centre, object.centre);
  assert.equal(all.radius, object.radius);
  assert.equal(object.reach, object.radius);
  assert.ok(all.reach > 50000);
  assert.equal(boundingBall({ positions: new Int32Array(0) }).radius, 1);
  assert.deepEqual(boundingBall({ positions: new Int32Array(0), grid: { bits: 4 } }).centre, [7.5, 7.5, 7.5]);
});
