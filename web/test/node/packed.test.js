// SPDX-License-Identifier: Apache-2.0
// What a point takes of a device's memory, and what it loses by it: packed_texels.js, packed_functions.js.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { SlfDecoder } from '../../slf_node.js';
import { packField } from '../../viewer/packed_field.js';
import { MOST_SHARE } from '../../viewer/packed_functions.js';
import * as texels from '../../viewer/packed_texels.js';
import { summary } from '../../viewer/point_pipeline.js';
import { caseOf } from './support.js';

const decoder = await SlfDecoder.create();
const surface = decoder.decode(caseOf('harmonics').bytes), splats = decoder.decode(caseOf('attributes').bytes);

test('a point takes 24 bytes, 4 more where directions are mirrored, a splat 40; then a byte for a weight of each channel', () => {
  for (const [field, own] of [[surface, surface.directions === 'reflected' ? 28 : 24], [splats, 40]]) {
    const packed = packField(field), cells = packed.columns * packed.rows, layers = Math.ceil(field.functions / 4);
    const words = 3 * layers + packed.fine;
    assert.equal(packed.weightLayers, Math.ceil(words / 4));
    assert.equal(summary(packed).bytes, cells * (own + 16 * packed.weightLayers) + layers * 6 * 65 * 65 * 4 * 2);
    const kept = Object.values(packed).filter(ArrayBuffer.isView).reduce((sum, each) => sum + each.byteLength, 0);
    assert.ok(kept < cells * (own + 16 * packed.weightLayers), `${kept} bytes in the heap`);
  }
});

test('what bytes of weights leave over is an eighth of a grey level, r.m.s. of a point', () => {
  const field = decoder.decode(caseOf('transform-harmonics').bytes), packed = packField(field);
  const { weights, functions, fine, layers, columns, rows } = packed, cells = columns * rows, exact = field.weights(), table = field.functionTable();
  assert.ok(fine > 0 && fine < field.functions, `${fine}`);
  const byte = (word, b, p) => (weights[((word >> 2) * cells + p) * 4 + (word & 3)] << (24 - 8 * b)) >> 24;
  const face = 4 * 65 * 65;
  let square = 0, count = 0;
  for (let p = 0; p < field.points; p += 7)
    for (let i = 0; i < 12; ++i) {
      const side = i % 6, x = (17 * p + 5 * i) % 65, y = (29 * p + 11 * i) % 65; // of the table, and where it is packed
      const at = (side * 65 + y) * 65 + x, to = (Math.floor(side / 3) * 65 + y) * functions.width + (side % 3) * 65 + x;
      for (let c = 0; c < 3; ++c) {
        let sum = 0, drawn = 0;
        for (let r = 0; r < field.functions; ++r)
          sum += exact[(p * field.functions + r) * 3 + c] * table.data[(r >> 2) * 6 * face + 4 * at + (r & 3)];
        for (let f = 0; f < field.functions; ++f) {
          const value = texels.fromHalf(functions.texels[(f >> 2) * functions.width * functions.height * 4 + 4 * to + (f & 3)]);
          drawn += value * (256 * byte(3 * (f >> 2) + c, f & 3, p) + (f < fine ? byte(3 * layers + f, c, p) : 0));
        }
        square += ((255 * drawn) / MOST_SHARE - sum) ** 2;
        ++count;
      }
    }
  const rest = Math.sqrt(square / count);
  assert.ok(rest > 0 && rest < 1 / 8, `${rest} grey levels`); // half floats of the functions have a part in it
});

test('places are exact to the last of 21 bits, and discs to a hundredth of a voxel', () => {
  const packed = { places: new Uint32Array(4 * 500) };
  for (let p = 0; p < 500; ++p) {
    const place = [p * 4003, 0x1fffff - p * 7, (p * 131071) & 0x1fffff], normal = [Math.sin(p), Math.cos(p) * Math.sin(3 * p), Math.cos(3 * p)],
      length = Math.hypot(...normal), unit = normal.map((v) => v / length), radius = 0.4 + p / 9, shift = 0.6 * Math.sin(p);
    texels.writeDisc(packed.places, p, place, unit, shift, radius, 0.5);
    assert.deepEqual(texels.placeOf(packed, p), place);
    assert.ok(Math.hypot(...texels.normalOf(packed, p).map((v, k) => v - unit[k])) < 1e-3);
    assert.ok(Math.abs(texels.shiftOf(packed, p) - shift) < 0.005);
    assert.ok(Math.abs(texels.radiusOf(packed, p) - radius) <= radius / 2048);
  }
  texels.writeDisc(packed.places, 0, [1, 2, 3], [0, 0, 0], 0, 1, 1);
  assert.deepEqual([texels.placeOf(packed, 0), texels.normalOf(packed, 0)], [[1, 2, 3], null]);
});

test('the thinnest of splats stays as thin as it is, whichever way it lies', () => {
  const places = new Uint32Array(4), tails = new Uint32Array(2);
  for (let turn = 0; turn < 60; ++turn) {
    const [c, s] = [Math.cos(turn), Math.sin(turn)], axes = [[c, s * 0.6, s * 0.8], [-s, c * 0.6, c * 0.8], [0, -0.8, 0.6]],
      variances = [2500, 400, 1e-4];
    const at = (i, k) => axes.reduce((sum, axis, a) => sum + variances[a] * axis[i] * axis[k], 0),
      covariance = [at(0, 0), at(0, 1), at(0, 2), at(1, 1), at(1, 2), at(2, 2)];
    texels.writeSplat(places, tails, 0, [5, 6, 7], covariance, 0.7);
    const { covariance: kept, opacity } = texels.splatOf({ places, tails }, 0), thin = axes[2];
    kept.forEach((v, i) => assert.ok(Math.abs(v - covariance[i]) < 2500 / 1000, `${v} for ${covariance[i]}`));
    const across = thin[0] ** 2 * kept[0] + thin[1] ** 2 * kept[3] + thin[2] ** 2 * kept[5] +
      2 * (thin[0] * thin[1] * kept[1] + thin[0] * thin[2] * kept[2] + thin[1] * thin[2] * kept[4]);
    assert.ok(across >= 0 && Math.sqrt(across) < 0.05, `${Math.sqrt(across)} voxels thick`); // 1/1000 of its length
    assert.ok(Math.abs(opacity - 0.7) < 1 / 2048);
  }
});

test('half floats: nearest, with denormals, none beyond the most', () => {
  for (const [number, half] of [[0, 0], [1, 0x3c00], [0.5, 0x3800], [65504, 0x7bff], [1e9, 0x7bff], [2 ** -24, 1], [2 ** -14, 0x400], [1 + 2 ** -11, 0x3c00]])
    assert.equal(texels.toHalf(number), half, `${number}`);
  for (let half = 0; half < 0x7c00; half += 13) assert.equal(texels.toHalf(texels.fromHalf(half)), half);
  assert.deepEqual([-2, -0.25, 3].map((v) => texels.fromHalf(texels.toSignedHalf(v))), [-2, -0.25, 3]);
});
