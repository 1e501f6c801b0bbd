// SPDX-License-Identifier: Apache-2.0
// The module by itself: options, arrays, memory, errors.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { readInfo } from '../../slf_headers.js';
import { SlfDecoder, SlfError } from '../../slf_node.js';
import { caseOf, cases } from './support.js';

const decoder = await SlfDecoder.create();
const harmonics = caseOf('harmonics'), basis = caseOf('basis');

function code(wanted) { return (error) => error instanceof SlfError && error.code === wanted; }

test('info says what the headers say', () => {
  const info = decoder.info(harmonics.bytes);
  assert.equal(info.version, '1.0');
  assert.equal(info.points, harmonics.expect[0].points);
  assert.equal(info.basis, 'harmonics');
  assert.equal(info.bytes, harmonics.bytes.length);
  assert.equal(info.complete, true);
  assert.ok(info.decodeBytes > info.points * info.components * 12);
  assert.equal(decoder.info(basis.bytes).metadata.note, 'größer');
  assert.equal(info.layers, 1);
  assert.equal(decoder.info(caseOf('layers-four').bytes).layers, 4);
});

test('no more layers than the group that has most', () => {
  const { bytes } = caseOf('layers');
  const first = decoder.decode(bytes, { layers: 1 });
  assert.ok(first.partial);
  first.release();
  assert.throws(() => decoder.decode(bytes, { layers: 3 }), code('INVALID_ARGUMENT'));
});

test('arguments of a wrong kind are refused before anything is done', () => {
  for (const options of [{ levels: 1.5 }, { levels: -1 }, { groups: NaN }, { region: { low: [0, 0], high: [1, 1, 1] } }])
    assert.throws(() => decoder.decode(harmonics.bytes, options), code('INVALID_ARGUMENT'));
  assert.throws(() => decoder.decode('text'), code('INVALID_ARGUMENT'));
  assert.throws(() => decoder.decode(harmonics.bytes, { levels: 22 }), code('INVALID_ARGUMENT'));
  assert.throws(() => decoder.decode(new Uint8Array()), code('NOT_SLF'));
});

test('limits are kept', () => {
  assert.throws(() => decoder.decode(harmonics.bytes, { maxPoints: 1 }), code('LIMIT_EXCEEDED'));
  assert.throws(() => decoder.decode(harmonics.bytes, { maxMemory: 1 << 20 }), code('LIMIT_EXCEEDED'));
});

test('progress rises to the end, and stops a decode', () => {
  const seen = [];
  decoder.decode(harmonics.bytes, { onProgress: (fraction) => { seen.push(fraction); } }).release();
  assert.ok(seen.length > 1);
  assert.ok(seen.every((x, i) => x >= 0 && x <= 1 && (i === 0 || x >= seen[i - 1])));
  assert.throws(() => decoder.decode(harmonics.bytes, { onProgress: () => false }), code('CANCELLED'));
  const mine = new Error('of the caller');
  assert.throws(() => decoder.decode(harmonics.bytes, { onProgress: () => { throw mine; } }), mine);
  decoder.decode(harmonics.bytes).release();
});

test('a field that was released is not read', () => {
  const field = decoder.decode(harmonics.bytes);
  const { positions } = field;
  field.release();
  field.release();
  assert.equal(positions.length, 3 * field.points, 'arrays handed out stay');
  assert.throws(() => field.weights(), code('INVALID_ARGUMENT'));
});

/** A few directions, no two alike. */
function directions(count) {
  return Array.from({ length: count }, (_, i) => [Math.cos(i), Math.sin(1.7 * i), Math.cos(2.3 * i + 1)]).flat();
}

/** Colours from weights and the function table, as a shader finds them. */
function shaded(field, table, point, world) {
  let omega = world.map((x) => x / Math.hypot(...world));
  if (field.mirrorNormals) {
    const n = field.mirrorNormals.subarray(3 * point, 3 * point + 3);
    const twice = 2 * (n[0] * omega[0] + n[1] * omega[1] + n[2] * omega[2]);
    omega = omega.map((x, k) => twice * n[k] - x);
  }
  const size = omega.map(Math.abs), axis = size.indexOf(Math.max(...size)), negative = omega[axis] < 0;
  const [x, y, z] = omega.map((c) => c / size[axis]);
  const [s, t] = [negative ? [z, -y] : [-z, -y], negative ? [x, -z] : [x, z], negative ? [-x, -y] : [x, -y]][axis];
  const face = 2 * axis + (negative ? 1 : 0), at = (c) => (c + 1) / 2 * (table.side - 1);
  const [i, j] = [at(s), at(t)].map((c) => Math.min(Math.floor(c), table.side - 2)), u = at(s) - i, v = at(t) - j;
  const weights = field.weights(), colour = [0, 0, 0];
  for (let r = 0; r < field.functions; ++r) {
    const texel = (a, b) => table.data[(((Math.floor(r / 4) * 6 + face) * table.side + b) * table.side + a) * 4 + r % 4];
    const e = (1 - v) * ((1 - u) * texel(i, j) + u * texel(i + 1, j)) + v * ((1 - u) * texel(i, j + 1) + u * texel(i + 1, j + 1));
    for (let c = 0; c < 3; ++c) colour[c] += e * weights[(point * field.functions + r) * 3 + c];
  }
  return colour.map((c) => Math.min(Math.max(c, 0), 255));
}

for (const one of [harmonics, basis])
  test(`${one.id}: weights and functions on a cube give the radiance`, () => {
    const field = decoder.decode(one.bytes), table = field.functionTable({ side: 257 });
    const along = directions(40), points = Array.from({ length: 40 }, (_, i) => (i * 7) % field.points);
    const exact = field.radiance(points, along);
    let worst = 0;
    for (let i = 0; i < 40; ++i)
      shaded(field, table, points[i], along.slice(3 * i, 3 * i + 3)).forEach((c, k) => {
        worst = Math.max(worst, Math.abs(c - exact[3 * i + k]));
      });
    // Splines of low order have edges that no table holds.
    const limit = field.info.basis === 'harmonics' ? 0.5 : 8;
    assert.ok(worst < limit, `${worst} grey levels`);
    field.release();
  });

test('planes without a basis have no colours', () => {
  const field = decoder.decode(caseOf('vector').bytes);
  assert.equal(field.hasBasis, false);
  assert.throws(() => field.weights(), code('INVALID_ARGUMENT'));
  assert.throws(() => field.meanColours(), code('INVALID_ARGUMENT'));
  assert.equal(field.mirrorNormals, null);
  field.release();
});

test('the discs are finite, their normals of unit length or none', () => {
  const field = decoder.decode(harmonics.bytes);
  assert.ok(field.radii.every((r) => r > 0 && Number.isFinite(r)));
  assert.ok(field.areas.every((a) => a > 0 && Number.isFinite(a)));
  for (let p = 0; p < field.points; ++p) {
    const length = Math.hypot(...field.normals.subarray(3 * p, 3 * p + 3));
    assert.ok(length === 0 || Math.abs(length - 1) < 1e-5);
    for (let k = 0; k < 3; ++k) assert.ok(Math.abs(field.centres[3 * p + k] - field.positions[3 * p + k]) <= 0.6001);
  }
  field.release();
});

test('every truncation is an error or a partial field', () => {
  const { bytes } = caseOf('two-points');
  for (let size = 0; size < bytes.length; ++size) {
    try {
      const field = decoder.decode(bytes.subarray(0, size));
      assert.ok(field.partial, `${size} bytes`);
      field.release();
    } catch (error) {
      assert.ok(error instanceof SlfError && error.code !== 'INTERNAL', `${size} bytes: ${error}`);
    }
  }
});

test('damaged streams are errors, twenty times each, and memory does not grow', () => {
  const damaged = cases('refused');
  const round = () => {
    for (const { bytes } of damaged) {
      try {
        decoder.decode(bytes).release();
      } catch (error) {
        assert.ok(error instanceof SlfError && error.code !== 'INTERNAL', String(error));
      }
    }
  };
  round();
  globalThis.gc?.();
  const before = process.memoryUsage().arrayBuffers;
  for (let i = 0; i < 20; ++i) round();
  globalThis.gc?.();
  assert.ok(process.memoryUsage().arrayBuffers - before < 64 << 20);
});

test('twenty loads of one file take the memory of one', () => {
  const load = () => {
    const field = decoder.decode(harmonics.bytes);
    field.weights();
    field.normals;
    field.release();
    const idle = decoder.take();
    const { bytes } = idle;
    decoder.give(idle);
    return bytes;
  };
  const first = load();
  for (let i = 0; i < 19; ++i) assert.ok(load() <= first, 'the instance has grown');
});

test('memory of a large decode serves the next, and is let go of after five seconds or by trim()', (t) => {
  t.mock.timers.enable({ apis: ['setTimeout'] });
  const large = () => {
    const instance = decoder.take();
    instance.wasm.slfw_free(instance.alloc(64 << 20));
    decoder.give(instance);
    return instance;
  };
  const used = () => {
    const instance = decoder.take();
    decoder.give(instance);
    return instance;
  };
  const first = large();
  t.mock.timers.tick(4000);
  assert.equal(used(), first);
  t.mock.timers.tick(4000);
  assert.equal(used(), first, 'five seconds since it was used last');
  t.mock.timers.tick(5001);
  const second = large();
  assert.notEqual(second, first);
  decoder.trim();
  assert.notEqual(used(), second);
});

test('what WebAssembly cannot hold is an error, and the next decode works', () => {
  const { length } = harmonics.bytes;
  const instance = decoder.take();
  assert.throws(() => instance.call(() => instance.alloc(0xfffffff0)), code('OUT_OF_MEMORY'));
  decoder.give(instance);
  decoder.decode(harmonics.bytes).release();
  assert.equal(harmonics.bytes.length, length);
});

test('memory that is free at the end counts towards a block: 3.5 of 4 GiB can be had', () => {
  const instance = decoder.take();
  for (const share of [1.2, 0.8, 1.5]) assert.ok(instance.alloc(share * 2 ** 30 >>> 0) > 0);
  instance.dead = true; // not to be kept
  decoder.give(instance);
});

test('a refused argument leaves the field as it was', () => {
  const field = decoder.decode(harmonics.bytes), plain = decoder.decode(caseOf('vector').bytes);
  for (const refused of [
    () => field.radiance([field.points], [0, 0, 1]),
    () => field.radiance([5.7], [0, 0, 1]),
    () => field.radiance([2 ** 32 + 5], [0, 0, 1]),
    () => field.radiance([0], [0, 0]),
    () => field.weights(new Float32Array(3)),
    () => field.functionTable({ side: 1 }),
    () => field.functionTable({ side: 2.5 }),
    () => field.functionTable({ side: 1025 }),
    () => plain.weights(),
    () => plain.functionTable(),
  ])
    assert.throws(refused, code('INVALID_ARGUMENT'), String(refused));
  assert.equal(field.weights().length, 3 * field.functions * field.points);
  assert.equal(plain.positions.length, 3 * plain.points);
  field.release();
  plain.release();
});

test('what is refused again and again takes no memory', () => {
  const field = decoder.decode(harmonics.bytes);
  const points = new Uint32Array(50000).fill(field.points), along = new Float32Array(150000);
  for (let i = 0; i < 200; ++i) assert.throws(() => field.radiance(points, along), code('INVALID_ARGUMENT'));
  field.release();
  const { bytes } = decoder.take();
  assert.ok(bytes < 64 << 20, `${bytes} bytes`);
});

test('a block of 4 GiB or more is a lack of memory, not a block of what is left of its size', () => {
  const instance = decoder.take();
  for (const bytes of [2 ** 32, 2 ** 32 + 100, 6 * 2 ** 30])
    assert.throws(() => instance.call(() => instance.alloc(bytes)), code('OUT_OF_MEMORY'));
  instance.call(() => instance.alloc(100));
  decoder.give(instance);
});

test('after release() every question is refused alike', () => {
  const field = decoder.decode(harmonics.bytes);
  field.release();
  for (const asked of [() => field.kernel, () => field.functionTable(), () => field.radiance([0], [0, 0, 1]),
    () => field.positions, () => field.meanColours()])
    assert.throws(asked, code('INVALID_ARGUMENT'), String(asked));
});

test('an option beyond its range is refused with the range', () => {
  assert.throws(() => decoder.decode(harmonics.bytes, { levels: 300 }), /levels must be a whole number, 0 to 255/);
});

test('a metadata key may be any word', () => {
  // of a file that is not at hand
  const instance = { wasm: { slfw_info: () => 0, slfw_metadata: (_, i, value) => 2 * i + value },
    numbers: (count) => new Array(count).fill(1), text: (at) => ['__proto__', 'x'][at] };
  assert.deepEqual(Object.entries(readInfo(instance, 1).metadata), [['__proto__', 'x']]);
});

test('info says what a decode takes, however much that is', () => {
  // Beyond the limits of decode() by itself is no file that is small enough to be here: the limits that are asked with.
  const own = new SlfDecoder(decoder.module), instance = own.take(), set = instance.setNumbers.bind(instance);
  const asked = [];
  instance.setNumbers = (values) => {
    asked.push(...values.slice(10, 13)); // points, memory, work
    set(values);
  };
  own.give(instance);
  assert.ok(own.info(harmonics.bytes).decodeBytes > 0);
  assert.deepEqual(asked, new Array(3).fill(Number.MAX_SAFE_INTEGER));
});

test('a decoder that cannot be loaded is an SlfError of the network', async () => {
  for (const wasm of [new Uint8Array([0, 1, 2]), 'http://127.0.0.1:9/slf.wasm', new Response('', { status: 404 })])
    await assert.rejects(SlfDecoder.create({ wasm }), code('NETWORK'));
});
