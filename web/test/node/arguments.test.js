// SPDX-License-Identifier: Apache-2.0
// A caller's mistake is refused where it enters, by the argument's name: no file and no network is blamed for it.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { SlfDecoder, SlfError } from '../../slf_node.js';
import { caseOf, digest } from './support.js';

const decoder = await SlfDecoder.create();
const { bytes, expect: [{ points }] } = caseOf('harmonics');
const moving = caseOf('frames-groups').bytes; // frames 0 and 1, then 2

/** An error that says INVALID_ARGUMENT and the argument's name. */
function names(argument) {
  return (error) => error instanceof SlfError && error.code === 'INVALID_ARGUMENT' && error.element === argument
    && error.message.startsWith(`INVALID_ARGUMENT: ${argument}`) && error.message.length > argument.length + 24;
}

function readerOfFrames() {
  const reader = decoder.frames();
  reader.push(moving);
  reader.finish();
  return reader;
}

/** [option, what it must not be] */
const NO_COUNTS = [-1, 1.5, NaN, '3', true, [], -Infinity, 2 ** 60];
const REFUSED_OPTIONS = [
  ...['levels', 'groups', 'layers', 'maxBytes'].flatMap((name) => [...NO_COUNTS, Infinity].map((value) => [name, { [name]: value }])),
  ...['maxPoints', 'maxMemory', 'maxWork'].flatMap((name) => NO_COUNTS.map((value) => [name, { [name]: value }])),
  ['onProgress', { onProgress: 3 }],
  ['options', null], ['options', 7], ['options', 'x'],
];
const REFUSED_REGIONS = [
  ['region.high', { low: [0, 0, 0] }],
  ['region.low', { high: [9, 9, 9] }],
  ['region.low', { min: [0, 0, 0], max: [9, 9, 9] }],
  ['region.low', [[0, 0, 0], [9, 9, 9]]],
  ['region.low', {}],
  ['region.low', { low: [0, 0], high: [9, 9, 9] }],
  ['region.high', { low: [0, 0, 0], high: [9, NaN, 9] }],
  ['region.high', { low: [0, 0, 0], high: [9, '9', 9] }],
  ['region.low', { low: [0, 5, 0], high: [9, 4, 9] }],
  ['region.low', 5],
].map(([argument, region]) => [argument, { region }]);

test('options of a decode that are none are refused by name, by every function that takes them', () => {
  const reader = readerOfFrames();
  for (const [argument, options] of [...REFUSED_OPTIONS, ...REFUSED_REGIONS])
    for (const call of [() => decoder.decode(bytes, options), () => decoder.preflight(bytes, options), () => decoder.frames(options),
      () => reader.setOptions(options), () => reader.preflight(0, options)])
      assert.throws(call, names(argument), `${call} of ${argument} ${JSON.stringify(options)}`);
  reader.release();
});

test('a refused option leaves a reader of frames as it was', () => {
  const reader = readerOfFrames(), other = readerOfFrames();
  assert.throws(() => reader.setOptions({ levels: -1 }));
  assert.throws(() => reader.preflight(0, { region: {} }));
  const field = reader.decode(2), same = other.decode(2);
  assert.equal(digest(field.positions), digest(same.positions));
  reader.release();
  other.release();
});

test('a limit of Infinity is none, and a region that is left out is the whole', () => {
  for (const options of [{ maxMemory: Infinity, maxPoints: Infinity, maxWork: Infinity }, { region: null }, { region: undefined }]) {
    const field = decoder.decode(bytes, options);
    assert.equal(field.points, points);
    field.release();
  }
});

test('levels, groups and layers beyond those of the file are refused in words', () => {
  for (const name of ['levels', 'groups', 'layers']) assert.throws(() => decoder.decode(bytes, { [name]: 20 }), names(name));
});

test('bytes that are none are refused by name; those of another realm are bytes', async () => {
  for (const none of [null, undefined, 'abc', 5, [...bytes], new Blob([bytes]), Promise.resolve(bytes)])
    for (const call of [() => decoder.decode(none), () => decoder.info(none), () => decoder.preflight(none), () => decoder.frames().push(none)])
      assert.throws(call, names('bytes'));
  const { runInNewContext } = await import('node:vm'), foreign = runInNewContext(`new ArrayBuffer(${bytes.length})`);
  new Uint8Array(foreign).set(bytes);
  for (const same of [foreign, new DataView(foreign)]) assert.equal(decoder.info(same).points, points);
});

test('places of frames that are none are refused by name', () => {
  const reader = readerOfFrames();
  for (const place of [-1, 3, 99, 1.5, NaN, '1', 'length', undefined])
    for (const call of [() => reader.groupOf(place), () => reader.decode(place), () => reader.preflight(place), () => reader.seek(place),
      () => reader.dropBefore(place)])
      assert.throws(call, names('place'), `${call} of ${place}`);
  for (const place of [-1, 1.5, '1', 'length', undefined]) assert.throws(() => reader.holds(place), names('place'), String(place));
  assert.ok(!reader.holds(99));
  assert.deepEqual([0, 1, 2].map((place) => reader.groupOf(place)), [0, 0, 2]);
  reader.release();
});

test('what is asked of a frame that is not predicted is refused of another, and the first of its group is named', () => {
  const reader = readerOfFrames();
  for (const call of [() => reader.preflight(1), () => reader.seek(1)]) {
    assert.throws(call, names('place'));
    assert.throws(call, /not predicted, as 0 is/);
  }
  assert.ok(reader.preflight(2).memoryBytes > 0);
  assert.throws(() => reader.push(moving), names('finish'));
  reader.release();
});

test('arguments of a field are refused by name', () => {
  const field = decoder.decode(bytes);
  for (const [argument, call] of [
    ['first and count', () => field.weights(undefined, NaN, 1)],
    ['first and count', () => field.weights(undefined, points, 1)],
    ['out', () => field.weights(new Float64Array(3 * points * field.functions))],
    ['side', () => field.functionTable({ side: '8' })],
    ['directions', () => field.radiance()],
    ['directions', () => field.radiance(7, [0, 0, 1])],
    ['directions', () => field.radiance([1], [0, 0, NaN])],
    ['points', () => field.radiance([-1], [0, 0, 1])],
    ['points', () => field.radiance([points], [0, 0, 1])],
  ])
    assert.throws(call, names(argument), String(call));
  field.release();
});
