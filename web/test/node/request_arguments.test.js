// SPDX-License-Identifier: Apache-2.0
// A caller's mistake is not blamed on the network, nor on a worker or a frame: it is refused by name, and nothing is asked for.
import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { SlfDecoder, SlfError, SlfFrameStream, SlfStream, frames } from '../../slf_node.js';
import { SlfWorker } from '../../slf_worker.js';
import { caseOf, serve } from './support.js';

const decoder = await SlfDecoder.create();
const { bytes, expect: [{ points }] } = caseOf('harmonics');
const moving = caseOf('frames-groups').bytes;
const server = await serve({ still: bytes, moving });
after(() => server.close());

/** An error that says INVALID_ARGUMENT and the argument's name. */
function names(argument) {
  return (error) => error instanceof SlfError && error.code === 'INVALID_ARGUMENT' && error.element === argument;
}

test('what is no decoder, and no address of one, is refused by name', async () => {
  for (const wasm of [5, {}, true, 'slf.wasm', '/slf.wasm', Promise.resolve(5)])
    await assert.rejects(SlfDecoder.create({ wasm }), names('wasm'), String(wasm));
  const read = new Response(new Uint8Array(8));
  await read.arrayBuffer();
  await assert.rejects(SlfDecoder.create({ wasm: read }), names('wasm'));
  await assert.rejects(SlfDecoder.create({ locateFile: '/parts/' }), names('locateFile'));
});

const REFUSED_REQUESTS = [
  ['stallMs', { stallMs: NaN }], ['stallMs', { stallMs: -1 }], ['stallMs', { stallMs: 0 }], ['stallMs', { stallMs: '300' }],
  ['headers', { headers: 5 }], ['headers', { headers: { 'no name': 'x' } }], ['credentials', { credentials: 'all' }],
  ['signal', { signal: new AbortController() }], ['fetch', { fetch: 'fetch' }], ['decoder', { decoder: SlfDecoder.create() }],
];

test('options of a request that are none are refused by name, and nothing is asked for', async () => {
  for (const [argument, options] of REFUSED_REQUESTS) {
    await assert.rejects(SlfStream.open(server.url('still'), { decoder, ...options }), names(argument), argument);
    await assert.rejects(SlfFrameStream.open(server.url('moving'), { decoder, ...options }), names(argument), argument);
  }
  await assert.rejects(SlfStream.open(server.url('still'), { decoder, onProgress: 5 }), names('onProgress'));
  for (const keepBytes of [NaN, -1, '9', null])
    await assert.rejects(SlfFrameStream.open(server.url('moving'), { decoder, keepBytes }), names('keepBytes'));
  await assert.rejects(SlfFrameStream.open(server.url('moving'), { decoder, levels: -1 }), names('levels'));
  assert.equal(server.requests.length, 0);
});

test('what is no address is refused by name; what a fetch of the caller is given may be any text', async () => {
  for (const url of [undefined, null, 5, {}, 'not a url', '/file.slf', 'http://['])
    await assert.rejects(SlfStream.open(url, { decoder }), names('url'), String(url));
  for (const source of [undefined, null, 5, {}, 'not a url'])
    await assert.rejects(frames(source, { decoder }).next(), names('source'), String(source));
  const own = async (url) => (assert.equal(url, 'still'), new Response(bytes));
  assert.equal((await SlfStream.open('still', { decoder, fetch: own })).info.points, points);
});

test('a silence may last for ever, and headers may be Headers', async () => {
  const stream = await SlfStream.open(server.url('still'), { decoder, stallMs: Infinity, headers: new Headers({ 'X-Own': '1' }) });
  assert.equal(stream.info.points, points);
  const all = await SlfFrameStream.open(server.url('moving'), { decoder, keepBytes: Infinity, stallMs: 2 ** 40 });
  assert.ok(await all.arrive(2));
  assert.equal(all.heldBytes, moving.length);
  await all.close();
});

test('what the caller passes to a stream that is open is refused before anything is read', async () => {
  const stream = await SlfStream.open(server.url('still'), { decoder }), before = server.requests.length;
  assert.throws(() => stream.preflight({ levels: NaN }), names('levels'));
  await assert.rejects(stream.decode({ onProgress: 3 }), names('onProgress'));
  await assert.rejects(stream.read({ region: { low: [0, 0, 0] } }), names('region.high'));
  await assert.rejects(stream.read({}, { onRead: 3 }), names('onRead'));
  await assert.rejects(stream.read({}, { signal: new AbortController() }), names('signal'));
  assert.equal(server.requests.length, before);
  const moves = await SlfFrameStream.open(moving, { decoder });
  for (const place of [-1, 1.5, NaN, '0', undefined]) {
    await assert.rejects(moves.arrive(place), names('place'));
    await assert.rejects(moves.decode(place), names('place'));
  }
  await assert.rejects(moves.decode(3), names('place'));
  assert.throws(() => moves.preflight(1), names('place'));
  await moves.close();
});

test("what a caller's function throws is the caller's, and no error of the network", async () => {
  const mine = new Error('mine'), fail = () => { throw mine; };
  await assert.rejects(SlfStream.open(server.url('still'), { decoder, onProgress: fail }), (error) => error === mine);
});

test('where there is no Worker, one has to be given', async () => {
  await assert.rejects(SlfWorker.create(), names('worker'));
  for (const worker of [5, {}, () => undefined, async () => 'worker'])
    await assert.rejects(SlfWorker.create({ wasm: decoder.module, worker }), names('worker'));
});

test('what is asked of a worker is refused by name, before it hears of it', async () => {
  const asked = [];
  const worker = {
    postMessage({ id, call }) {
      asked.push(call);
      queueMicrotask(() => worker.onmessage({ data: { id, result: { info: {} } } }));
    },
    terminate() {},
  };
  const slf = await SlfWorker.create({ wasm: decoder.module, worker });
  const stream = await slf.open('http://localhost/a.slf'), moves = await slf.openFrames(moving);
  assert.deepEqual(asked.splice(0), ['create', 'open', 'openFrames']);
  for (const [argument, call] of [
    ['bytes', () => slf.info('abc')],
    ['bytes', () => slf.decode(null, {}, { transfer: true })],
    ['levels', () => slf.decode(bytes, { levels: -1 })],
    ['region.low', () => slf.decode(bytes, { region: {} })],
    ['onProgress', () => slf.decode(bytes, { onProgress() {} })],
    ['arrays', () => slf.decode(bytes, {}, { arrays: ['positions', 'nonsense'] })],
    ['arrays', () => slf.decode(bytes, {}, { arrays: 'positions' })],
    ['side', () => slf.decode(bytes, {}, { functionTable: { side: 1 } })],
    ['signal', () => slf.decode(bytes, {}, { signal: new AbortController() })],
    ['url', () => slf.open(5)],
    ['levels', () => stream.decode({ levels: 1.5 })],
    ['onRead', () => stream.decode({}, { onRead: 5 })],
    ['arrays', () => moves.frame(0, { arrays: ['toString'] })],
  ])
    await assert.rejects(call, names(argument), String(call));
  assert.deepEqual(asked, []);
});
