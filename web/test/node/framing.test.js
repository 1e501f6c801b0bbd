// SPDX-License-Identifier: Apache-2.0
// What views of a whole light field frame.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { boundingBall } from '../../viewer/packed_field.js';
import { namedPose } from '../../viewer/view.js';

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

test('of splats a tenth may be sky', () => {
  const object = Array.from({ length: 900 }, (_, i) => [1000 + ((i * 7) % 64), 1000 + ((i * 11) % 64), 1000 + ((i * 13) % 64)]);
  const sky = Array.from({ length: 100 }, (_, i) => [60000, 600 * i, 60000 - 600 * i]);
  const positions = new Int32Array([...object, ...sky].flat());
  assert.ok(boundingBall({ positions, hasSplats: true }).radius < 100);
  assert.ok(boundingBall({ positions }).radius > 10000);
});

test("a file's own view is where its metadata says, or nowhere", () => {
  const field = { up: '+z' };
  const pose = namedPose(field, { view: '0 -5 1 0 0 1 40' });
  assert.deepEqual(pose.target, [0, 0, 1]);
  assert.equal(pose.distance, 5);
  assert.ok(Math.abs(pose.azimuth + 90) < 1e-9 && Math.abs(pose.elevation) < 1e-9);
  assert.equal(pose.fov, 40);
  for (const view of ['', '1 2 3', '0 0 0 0 0 0 40', '0 -5 1 0 0 1 0.5', '0 -5 1 0 0 1 171', 'NaN -5 1 0 0 1 40', '0  -5 1 0 0 1 40',
    '1e300 0 0 -1e300 0 0 40'])
    assert.equal(namedPose(field, { view }), null, view);
  assert.equal(namedPose(field, {}), null);
  assert.equal(namedPose(field, undefined), null);
});
