// SPDX-License-Identifier: Apache-2.0
// Frames by a worker: the page's side and the worker's own code, without a thread between them.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { SlfDecoder, SlfError } from '../../slf_node.js';
import { SlfWorker } from '../../slf_worker.js';
import { cases, digest } from './support.js';

const groups = cases('streams').find((one) => one.id === 'frames-groups').bytes;
const worker = { postMessage: (data) => queueMicrotask(() => globalThis.onmessage({ data })), terminate() {} };
globalThis.postMessage = (data) => worker.onmessage?.({ data });
await import('../../slf_worker_service.js');
const slf = await SlfWorker.create({ worker });

const decoder = await SlfDecoder.create(), reader = decoder.frames();
reader.push(groups);
reader.finish();
const whole = reader.list.map(({ place }) => {
  const field = reader.decode(place), digests = [digest(field.positions), digest(field.values)];
  field.release();
  return digests;
});

test('frames come in order, with the arrays that were asked for', async () => {
  const found = [];
  for await (const frame of slf.frames(groups, {}, { arrays: ['positions', 'values'] })) {
    assert.equal(frame.time, reader.list[frame.place].time);
    assert.equal(frame.field.radii, undefined);
    found.push([digest(frame.field.positions), digest(frame.field.values)]);
  }
  assert.deepEqual(found, whole);
});

test('any frame of a stream that is open, and none after it is closed', async () => {
  const stream = await slf.openFrames(groups);
  assert.equal(stream.info.points, reader.info().points);
  for (const place of [2, 0, 1]) {
    const { field } = await stream.frame(place, { arrays: ['positions'] });
    assert.equal(digest(field.positions), whole[place][0]);
  }
  assert.equal(await stream.frame(3), null);
  await stream.close();
  await assert.rejects(stream.frame(0), { code: 'INVALID_ARGUMENT' });
});

test('a damaged frame is an error of its own', async () => {
  const bytes = groups.map((b, i) => (i === reader.list[1].offset + 60 ? b ^ 4 : b)), said = [];
  for await (const { place, field, error } of slf.frames(bytes)) {
    said.push([place, field !== null]);
    if (error) assert.ok(error instanceof SlfError && error.bitOffset > 8 * reader.list[1].offset);
  }
  assert.deepEqual(said, [[0, true], [1, false], [2, true]]);
});

test('what is no stream, and no address, is refused', async () => {
  await assert.rejects(slf.openFrames(new Uint8Array(20)), { code: 'NOT_SLF' });
  await assert.rejects(slf.openFrames('http://['), { code: 'INVALID_ARGUMENT' });
});
