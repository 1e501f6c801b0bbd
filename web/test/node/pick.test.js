// SPDX-License-Identifier: Apache-2.0
// Rays against a light field, on the processor: pick.js.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { SlfDecoder } from '../../slf_node.js';
import { packField } from '../../viewer/packed_field.js';
import { colourFrom, pick } from '../../viewer/pick.js';
import { caseOf } from './support.js';

const { bytes } = caseOf('harmonics');
const field = (await SlfDecoder.create()).decode(bytes), packed = packField(field);

/** A field of discs of radius 1 with these places and normals. */
function discs(...list) {
  const out = { points: list.length, places: new Float32Array(4 * list.length), discs: new Float32Array(4 * list.length) };
  list.forEach(([place, normal], i) => {
    out.places.set([...place, 0], 4 * i);
    out.discs.set([...normal, 1], 4 * i);
  });
  return out;
}

test('the colour of a point along a way is its radiance there', () => {
  const eyes = [[9, 4, 30], [-40, 3, 2], [5, -60, -20]];
  let most = 0;
  for (const eye of eyes) {
    const points = Uint32Array.from({ length: Math.min(200, field.points) }, (_, i) => Math.floor((i * field.points) / 200) % field.points);
    const ways = Float64Array.from([...points].flatMap((p) => {
      const way = [0, 1, 2].map((k) => eye[k] - packed.places[4 * p + k]), length = Math.hypot(...way);
      return way.map((x) => x / length);
    }));
    const exact = field.radiance(points, ways);
    points.forEach((p, i) => colourFrom(packed, p, eye).forEach((v, k) => {
      most = Math.max(most, Math.abs(255 * v - Math.max(0, Math.min(255, exact[3 * i + k]))));
    }));
  }
  assert.ok(most < 1, `${most} grey levels`); // the table's own: docs/decisions/028
});

test('the nearest disc is met, from either side, and none behind the eye or beside the ray', () => {
  const two = discs([[0, 0, 5], [0, 0, 1]], [[0, 0, 9], [0, 0, -1]]);
  const met = pick(two, [0, 0, 0], [0, 0, 1]);
  assert.deepEqual([met.index, met.distance, met.normal.map((x) => x + 0)], [0, 5, [0, 0, -1]]);
  assert.equal(pick(two, [0, 0, 7], [0, 0, 1]).index, 1);
  assert.equal(pick(two, [0, 0, 10], [0, 0, 1]), null);
  assert.equal(pick(two, [1.01, 0, 0], [0, 0, 1]), null);
});

test('a core that is behind a rim fixes the depth, a rim alone does', () => {
  const shifted = discs([[0.9, 0, 4], [0, 0, 1]], [[0, 0, 5], [0, 0, 1]]);
  assert.equal(pick(shifted, [0, 0, 0], [0, 0, 1]).index, 1);
  assert.equal(pick(discs([[0.9, 0, 4], [0, 0, 1]]), [0, 0, 0], [0, 0, 1]).index, 0);
});

test('a disc without a normal looks at the eye, one on edge is met where it is nearest, no point is no hit', () => {
  const met = pick(discs([[0, 0.2, 5], [0, 0, 0]]), [0, 0, 0], [0, 0, 1]);
  assert.deepEqual([met.distance, met.normal.map((x) => x + 0)], [5, [0, 0, -1]]);
  assert.equal(pick(discs([[0, 0, 5], [0, 1, 0]]), [0, 0, 0], [0, 0, 1]).distance, 5);
  assert.equal(pick({ points: 0, places: new Float32Array(4), discs: new Float32Array(4) }, [0, 0, 0], [0, 0, 1]), null);
});
