// SPDX-License-Identifier: Apache-2.0
// Rays against a light field, on the processor: pick.js.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { SlfDecoder } from '../../slf_node.js';
import { packField } from '../../viewer/packed_field.js';
import { placeOf, writeDisc } from '../../viewer/packed_texels.js';
import { colourFrom, pick } from '../../viewer/pick.js';
import { caseOf } from './support.js';

const { bytes } = caseOf('harmonics');
const field = (await SlfDecoder.create()).decode(bytes), packed = packField(field);

/** A field of discs of radius 10 with these places and normals. */
function discs(...list) {
  const out = { points: list.length, middle: [100, 100, 100], places: new Uint32Array(4 * Math.max(1, list.length)) };
  list.forEach(([place, normal], i) => writeDisc(out.places, i, place.map((v) => v + 100), normal, 0, 10, 1));
  return out;
}

test('the colour of a point along a way is its radiance there', () => {
  const eyes = [[9, 4, 30], [-40, 3, 2], [5, -60, -20]];
  let most = 0;
  for (const eye of eyes) {
    const points = Uint32Array.from({ length: Math.min(200, field.points) }, (_, i) => Math.floor((i * field.points) / 200) % field.points);
    const ways = Float64Array.from([...points].flatMap((p) => {
      const place = placeOf(packed, p), way = [0, 1, 2].map((k) => eye[k] + packed.middle[k] - place[k]), length = Math.hypot(...way);
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
  const two = discs([[0, 0, 50], [0, 0, 1]], [[0, 0, 90], [0, 0, -1]]);
  const met = pick(two, [0, 0, 0], [0, 0, 1]);
  assert.deepEqual([met.index, met.distance, met.normal.map((x) => x + 0)], [0, 50, [0, 0, -1]]);
  assert.equal(pick(two, [0, 0, 70], [0, 0, 1]).index, 1);
  assert.equal(pick(two, [0, 0, 100], [0, 0, 1]), null);
  assert.equal(pick(two, [10.1, 0, 0], [0, 0, 1]), null);
});

test('a core that is behind a rim fixes the depth, a rim alone does', () => {
  const shifted = discs([[9, 0, 40], [0, 0, 1]], [[0, 0, 50], [0, 0, 1]]);
  assert.equal(pick(shifted, [0, 0, 0], [0, 0, 1]).index, 1);
  assert.equal(pick(discs([[9, 0, 40], [0, 0, 1]]), [0, 0, 0], [0, 0, 1]).index, 0);
});

test('a disc without a normal looks at the eye, one on edge is met where it is nearest, no point is no hit', () => {
  const met = pick(discs([[0, 2, 50], [0, 0, 0]]), [0, 0, 0], [0, 0, 1]);
  assert.deepEqual([met.distance, met.normal.map((x) => x + 0)], [50, [0, 0, -1]]);
  assert.equal(pick(discs([[0, 0, 50], [0, 1, 0]]), [0, 0, 0], [0, 0, 1]).distance, 50);
  assert.equal(pick(discs(), [0, 0, 0], [0, 0, 1]), null);
});
