// SPDX-License-Identifier: Apache-2.0
// Reading in parts from servers of all manners.
import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { SlfDecoder, SlfError } from '../../slf_node.js';
import { SlfStream } from '../../slf_stream.js';
import { caseOf, cases, digest, serve } from './support.js';

const decoder = await SlfDecoder.create();
const streams = cases('streams').filter((one) => !/^(draco|texture-)/.test(one.id));
/** More than the first request gives. */
const large = streams.filter((one) => one.bytes.length > 1 << 16);
/** Of these one whose first part has all headers: a decode asks for the rest. */
const [short] = large.filter(({ id }) => !id.startsWith('header-'));
const server = await serve(Object.fromEntries(streams.map((one) => [one.id, one.bytes])));
after(() => server.close());

function same(a, b, what) {
  assert.equal(a.points, b.points, what);
  assert.equal(digest(a.positions), digest(b.positions), what);
  assert.equal(digest(Int32Array.from(a.values)), digest(Int32Array.from(b.values)), what);
}

/** What can be asked for of a stream. */
function requests(info) {
  const all = [{}];
  for (const levels of new Set([1, Math.ceil(info.levels / 2), Math.max(1, info.levels - 1)])) all.push({ levels });
  if (info.groups > 1) all.push({ groups: 1 });
  const middle = 1 << (info.bits - 1);
  all.push({ region: { low: [0, 0, 0], high: [middle, middle, middle] } });
  return all;
}

test('the suite has streams that are read in parts', () => assert.ok(large.length > 0));

for (const one of streams)
  test(`${one.id}: parts decode as the whole does`, async () => {
    const stream = await SlfStream.open(server.url(one.id), { decoder });
    assert.equal(stream.bytes, one.bytes.length);
    for (const options of requests(stream.info)) {
      const parts = await stream.decode(options), whole = decoder.decode(one.bytes, options);
      same(parts, whole, JSON.stringify(options));
      parts.release();
      whole.release();
    }
  });

test('by an index not all is read, and nothing twice', async () => {
  let received = 0, all = 0;
  for (const one of large) {
    const stream = await SlfStream.open(server.url(one.id), { decoder });
    if (!stream.info.hasIndex) continue;
    const opened = stream.received, { readBytes } = stream.preflight({ groups: 1 });
    (await stream.decode({ groups: 1 })).release();
    assert.equal(stream.received, opened + readBytes, one.id);
    const before = server.requests.length;
    (await stream.decode({ groups: 1 })).release();
    assert.equal(server.requests.length, before, one.id);
    received += stream.received;
    all += one.bytes.length;
  }
  assert.ok(all > 0 && received < all, `${received} of ${all}`);
});

test('a connection that is lost before an answer is made again', async () => {
  const stream = await SlfStream.open(server.url('two-points', '?manner=nothing%20at%20first'), { decoder });
  assert.equal(stream.info.points, 2);
});

test('a server that ignores ranges is read whole', async () => {
  for (const one of large) {
    const stream = await SlfStream.open(server.url(one.id, '?manner=whole'), { decoder });
    assert.equal(stream.ranged, false);
    const field = await stream.decode({ groups: 1 });
    assert.equal(stream.received, one.bytes.length);
    field.release();
  }
});

test('sizes that may not be seen make it read whole', async () => {
  const stream = await SlfStream.open(server.url(short.id, '?manner=no%20Content-Range'), { decoder });
  (await stream.decode()).release();
  assert.equal(stream.received, short.bytes.length);
});

for (const manner of ['another part', 'less than it says', 'more than it says', 'another size', 'cut off', 'missing'])
  test(`an error where the second answer is: ${manner}`, async () => {
    const url = server.url(short.id, `?manner=${encodeURIComponent(manner)}&after=1&x=${Math.random()}`);
    const stream = await SlfStream.open(url, { decoder });
    await assert.rejects(stream.decode(), (error) => error instanceof SlfError && error.code === 'NETWORK');
  });

for (const manner of ['less than it says', 'more than it says', 'cut off', 'missing'])
  test(`an error where the first answer is: ${manner}`, async () => {
    const url = server.url('two-points', `?manner=${encodeURIComponent(manner)}`);
    await assert.rejects(SlfStream.open(url, { decoder }), (error) => error instanceof SlfError && error.code === 'NETWORK');
  });

test('a stall ends, and says so', async () => {
  const url = server.url('two-points', '?manner=stalls');
  await assert.rejects(SlfStream.open(url, { decoder, stallMs: 50 }),
    (error) => error.code === 'NETWORK' && /nothing came for 50 ms/.test(error.message));
});

test('a caller ends a stall', async () => {
  const abort = new AbortController();
  const opening = SlfStream.open(server.url('two-points', '?manner=stalls'), { decoder, signal: abort.signal });
  setTimeout(() => abort.abort(), 30);
  await assert.rejects(opening, (error) => error instanceof SlfError && error.code === 'ABORTED');
});

test('damage on the way is found', async () => {
  const bytes = Uint8Array.from(caseOf(short.id).bytes);
  bytes[bytes.length - 60] ^= 4;
  const fetchDamaged = async (url, { headers }) => {
    const [begin, end] = /bytes=(\d+)-(\d+)/.exec(headers.Range).slice(1).map(Number);
    const stop = Math.min(end + 1, bytes.length);
    return new Response(bytes.subarray(begin, stop),
      { status: 206, headers: { 'Content-Range': `bytes ${begin}-${stop - 1}/${bytes.length}` } });
  };
  const stream = await SlfStream.open('http://nowhere.test/x.slf', { decoder, fetch: fetchDamaged });
  await assert.rejects(stream.decode(), (error) => error instanceof SlfError && error.code === 'CHECKSUM');
});

/** Answers as a server does, and what it was asked for; whole: from this request on all of the file. */
function answering(bytes, { whole = Infinity } = {}) {
  const asked = [];
  const get = async (url, { headers }) => {
    const range = /bytes=(\d+)-(\d+)/.exec(headers.Range ?? '');
    asked.push(headers.Range);
    if (!range || asked.length > whole)
      return new Response(bytes, { headers: { 'Content-Length': String(bytes.length) } });
    const begin = Number(range[1]), end = Math.min(Number(range[2]) + 1, bytes.length);
    return new Response(bytes.subarray(begin, end),
      { status: 206, headers: { 'Content-Range': `bytes ${begin}-${end - 1}/${bytes.length}` } });
  };
  return { asked, fetch: get };
}

test('a server that gives the whole file from some request on is asked once more, not for every range', async () => {
  const { bytes } = short, server = answering(bytes, { whole: 1 });
  const stream = await SlfStream.open('http://nowhere.test/x.slf', { decoder, fetch: server.fetch });
  assert.ok(stream.preflight({ groups: 1 }).requests > 1);
  await stream.read({ groups: 1 });
  assert.equal(server.asked.length, 2);
  assert.equal(stream.received, bytes.length);
});

test('two reads at once ask for nothing twice', async () => {
  const { bytes } = short, server = answering(bytes);
  const stream = await SlfStream.open('http://nowhere.test/x.slf', { decoder, fetch: server.fetch });
  const opened = stream.received, { readBytes, requests: count } = stream.preflight({ groups: 1 });
  const fields = await Promise.all([stream.decode({ groups: 1 }), stream.decode({ groups: 1 }), stream.read({ groups: 1 })]);
  assert.equal(server.asked.length, 1 + count);
  assert.equal(stream.received, opened + readBytes);
  same(fields[0], fields[1], 'both');
  for (const field of fields) field?.release();
});

test('a read that failed does not keep the next from its turn', async () => {
  const server = answering(short.bytes);
  const stream = await SlfStream.open('http://nowhere.test/x.slf', { decoder, fetch: server.fetch });
  const stopped = stream.read({}, { signal: AbortSignal.abort() }), next = stream.decode();
  await assert.rejects(stopped, (error) => error instanceof SlfError && error.code === 'ABORTED');
  (await next).release();
});

test('a decode whose signal was aborted before is not begun, though all is here', async () => {
  const stream = await SlfStream.open(server.url('two-points'), { decoder });
  await assert.rejects(stream.decode({}, { signal: AbortSignal.abort() }), (error) => error.code === 'ABORTED');
});

test('of another origin a length may be that before unpacking: it is not held against what came', async () => {
  const { bytes } = caseOf('two-points');
  const answer = (type) => async () => Object.defineProperty(
    new Response(bytes, { headers: { 'Content-Length': String(bytes.length + 20) } }), 'type', { value: type });
  const open = (type) => SlfStream.open('http://nowhere.test/x.slf', { decoder, fetch: answer(type) });
  assert.equal((await open('cors')).bytes, bytes.length);
  await assert.rejects(open('basic'), (error) => error.code === 'NETWORK');
});

test('the body of an answer that is of no use is cancelled', async () => {
  const { bytes } = caseOf('two-points');
  let cancelled = false;
  const get = async (url, { headers }) => (headers.Range
    ? new Response(new ReadableStream({ cancel() { cancelled = true; } }), { status: 206 })
    : new Response(bytes));
  await SlfStream.open('http://nowhere.test/x.slf', { decoder, fetch: get });
  assert.ok(cancelled);
});
