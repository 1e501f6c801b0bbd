// SPDX-License-Identifier: Apache-2.0
// The page's side of a decoding worker, against a worker that answers as the test wants.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { SlfError } from '../../slf_node.js';
import { SlfWorker } from '../../slf_worker.js';

function code(wanted) { return (error) => error instanceof SlfError && error.code === wanted; }

/** Answers `create`, keeps the rest. */
async function client() {
  const asked = [];
  const worker = {
    postMessage(message) {
      if (message.call === 'create') return queueMicrotask(() => worker.onmessage({ data: { id: message.id } }));
      structuredClone(message);
      asked.push(message);
    },
    terminate() {},
  };
  return { asked, worker, slf: await SlfWorker.create({ worker }) };
}

test('a signal ends a decode: before it is posted, and while it goes on', async () => {
  const { slf, asked } = await client();
  await assert.rejects(slf.decode(new Uint8Array(8), {}, { signal: AbortSignal.abort() }), code('ABORTED'));
  assert.equal(asked.length, 0);
  const abort = new AbortController(), going = slf.decode(new Uint8Array(8), {}, { signal: abort.signal });
  abort.abort();
  await assert.rejects(going, code('ABORTED'));
});

test('after terminate() every call is refused', async () => {
  const { slf } = await client();
  const going = slf.decode(new Uint8Array(8));
  slf.terminate();
  await assert.rejects(going, code('ABORTED'));
  await assert.rejects(slf.info(new Uint8Array(8)), code('ABORTED'));
});

test('a worker whose script cannot be loaded is an error of the network, now and later', async () => {
  const { slf, worker } = await client();
  const going = slf.info(new Uint8Array(8));
  worker.onerror({});
  await assert.rejects(going, code('NETWORK'));
  await assert.rejects(slf.info(new Uint8Array(8)), code('NETWORK'));
});

test('what cannot be posted is a refused argument', async () => {
  const { slf } = await client();
  await assert.rejects(slf.decode(new Uint8Array(8), { onProgress() {} }), code('INVALID_ARGUMENT'));
});

test('what is no address is a refused argument, and nothing is asked for', async () => {
  const { slf, asked } = await client();
  await assert.rejects(slf.open('http://['), code('INVALID_ARGUMENT'));
  assert.equal(asked.length, 0);
});
