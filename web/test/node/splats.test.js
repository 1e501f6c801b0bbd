// SPDX-License-Identifier: Apache-2.0
// Gaussian splats without a browser: their arrays, their order along a view, where rays meet them.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { SlfDecoder } from '../../slf_node.js';
import { buffersOf, packField } from '../../viewer/packed_field.js';
import { placeOf, splatOf, writeSplat } from '../../viewer/packed_texels.js';
import { pick } from '../../viewer/pick.js';
import { SplatOrder } from '../../viewer/splat_order.js';
import { axesOf, cross, dot, upAxes } from '../../viewer/view.js';
import { caseOf } from './support.js';

const decoder = await SlfDecoder.create();

test('a field has shapes and opacities where its points are splats, and nulls elsewhere', () => {
  const splats = decoder.decode(caseOf('attributes').bytes), surface = decoder.decode(caseOf('harmonics').bytes);
  assert.deepEqual([splats.hasSplats, splats.info.hasSplats], [true, true]);
  assert.deepEqual([splats.covariances.length, splats.opacities.length], [6 * splats.points, splats.points]);
  assert.ok(splats.opacities.every((a) => a >= 0 && a <= 1));
  assert.ok(splats.covariances.every((v, i) => ![0, 3, 5].includes(i % 6) || v >= 0), 'variances');
  assert.deepEqual([surface.hasSplats, surface.covariances, surface.opacities], [false, null, null]);
  splats.release();
  surface.release();
});

/** What packSplats() asks of a field, with splats at these places. */
function fieldOf(places, covariance, opacity = 0.9) {
  const points = places.length;
  return {
    points, components: 1, functions: 1, hasSplats: true, gamma: [-1, 1], transfer: 'display', up: '+z', partial: false,
    info: { points }, grid: { origin: [0, 0, 0], step: 1, bits: 8 }, positions: Uint32Array.from(places.flat()),
    covariances: Float32Array.from({ length: 6 * points }, (_, i) => covariance[i % 6]),
    opacities: new Float32Array(points).fill(opacity), areas: new Float32Array(points).fill(100),
    meanColours: () => new Uint8Array(3 * points), weights: () => new Float32Array(3 * points),
    functionTable: ({ side }) => ({ side, layers: 1, data: new Float32Array(24 * side * side) }),
  };
}

const FLAT = [4, 0, 0, 4, 0, 0.01]; // across z

test('shapes are packed in voxels; those that never show or are no numbers are left out', () => {
  const field = fieldOf([[0, 0, 0], [8, 0, 0], [16, 0, 0]], FLAT);
  field.grid.step = 0.5;
  field.opacities[1] = 0.003; // less than 1/255
  field.covariances[12] = Infinity;
  const packed = packField(field, 2);
  const { covariance } = splatOf(packed, 0);
  [16, 0, 0, 16, 0, 0.04].forEach((v, i) => assert.ok(Math.abs(covariance[i] - v) <= v / 1024));
  assert.deepEqual([0, 1, 2].map((p) => splatOf(packed, p).opacity > 0), [true, false, false]);
  assert.equal(new Set(buffersOf(packed)).size, 5, 'all that can be handed over');
  assert.ok(packed.reach >= packed.radius && packed.box[0][0] < 0 && packed.box[1][0] >= 8);
});

test('means of splats that are on their way are widened, the whole file is as it is', () => {
  const field = fieldOf([[0, 0, 0], [8, 0, 0]], FLAT);
  const variance = (arriving) => Math.round(splatOf(packField(field, 2, arriving), 0).covariance[0]);
  assert.equal(variance(true), 4);
  field.info.points = 20;
  assert.equal(variance(true), 34);
  assert.equal(variance(false), 4);
});

test('nothing is drawn nearer than the lesser of 0.2 and a fiftieth of the radius: spec E.6', () => {
  const nearest = (side) => packField(fieldOf([[0, 0, 0], [2 * side, 0, 0]], FLAT), 2).nearest;
  assert.deepEqual([nearest(100), nearest(5), nearest(0)], [0.2, 0.1, 0.2]);
});

/** Places all around, and the order that any sort has. */
function crowd(points, eye, forward, nearest) {
  const packed = { points, nearest, middle: [64, 64, 64], places: new Uint32Array(4 * points) }, tails = new Uint32Array(2 * points);
  const wave = (i) => 64 + Math.round(40 * Math.sin(i * i + 1));
  for (let p = 0; p < points; ++p)
    writeSplat(packed.places, tails, p, [wave(4 * p), wave(4 * p + 1), wave(4 * p + 2)], [1, 0, 0, 1, 0, 1], 0.5);
  const depth = (p) => Math.fround(placeOf(packed, p).reduce((sum, v, k) => sum + (v - 64 - eye[k]) * forward[k], 0));
  const depths = Float32Array.from({ length: points }, (_, p) => depth(p));
  const sorted = Array.from({ length: points }, (_, p) => p).filter((p) => depths[p] > nearest)
    .sort((a, b) => depths[a] - depths[b] || a - b).reverse();
  return { packed, sorted };
}

test('splats are in the order of depth, the farthest first, those of one depth as in the file', () => {
  const eye = [-50, 3, 1], forward = [0.6, 0, 0.8], { packed, sorted } = crowd(5000, eye, forward, 7);
  const order = new SplatOrder(packed);
  assert.equal(order.towards(eye, forward, 5000), true);
  assert.deepEqual([...order.order.subarray(0, order.count)], sorted);
  assert.ok(sorted.length < 5000, 'some are too near');
  assert.equal(order.towards(eye, forward, 5000), false, 'nothing to do');
  assert.ok(order.settled);
});

test('many are sorted in slices of time, with the order before them meanwhile', () => {
  const points = 400_000, eye = [-90, 0, 0], forward = [1, 0, 0];
  const { packed, sorted } = crowd(points, eye, forward, 1), other = crowd(points, [90, 0, 0], [-1, 0, 0], 1).sorted;
  const order = new SplatOrder(packed);
  order.towards(eye, forward, points); // the first is wanted at once
  const turn = (patient) => order.towards([90, 0, 0], [-1, 0, 0], points, patient);
  let calls = 1;
  while (!turn(true)) {
    assert.equal(order.settled, false);
    assert.equal(order.order[0], sorted[0], 'still that of before');
    assert.ok(++calls < 1000);
  }
  assert.ok(calls > 1, 'more than a slice');
  assert.deepEqual(order.order.subarray(0, order.count), Uint32Array.from(other));
  order.towards(eye, forward, points, true); // begun, and then another is wanted whole
  assert.equal(turn(false), false);
  order.towards(eye, forward, points);
  assert.deepEqual(order.order.subarray(0, order.count), Uint32Array.from(sorted));
});

test('a ray meets the splat with which half is hidden, and looks back along its flat side', () => {
  const packed = packField(fieldOf([[0, 0, 0], [0, 0, 8], [20, 0, 8]], FLAT, 0.4), 2), [x, y, z] = packed.centre;
  const met = pick(packed, [-x, -y, -20 - z], [0, 0, 1]);
  assert.equal(met.index, 1, 'the first hides less than half');
  assert.ok(Math.abs(met.distance - 28) < 1e-3);
  assert.ok(Math.abs(met.normal[2] + 1) < 1e-3);
  assert.equal(pick(packed, [-x + 10, -y, -20 - z], [0, 0, 1]), null, 'between them');
  assert.equal(pick(packed, [-x, -y, -20 - z], [0, 0, -1]), null, 'behind');
});

test('axes of every up are right-handed, and so are the views along them', () => {
  for (const up of ['+x', '-x', '+y', '-y', '+z', '-z', 'unknown']) {
    const [first, second, third] = upAxes(up), [right, down, forward] = axesOf({ azimuth: 40, elevation: 20 }, up);
    assert.equal(dot(cross(first, second), third), 1, up);
    assert.ok(Math.abs(dot(cross(right, down), forward) - 1) < 1e-12, up);
  }
});
