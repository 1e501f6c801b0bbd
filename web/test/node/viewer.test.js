// SPDX-License-Identifier: Apache-2.0
// What of the viewer needs no browser: bytes on their way, decodes of a part, the loader of three.js.
import assert from 'node:assert/strict';
import { existsSync } from 'node:fs';
import { test } from 'node:test';
import { SlfDecoder, SlfError } from '../../slf_node.js';
import { DecodeSession, plainError } from '../../viewer/decode_session.js';
import { FieldLoader } from '../../viewer/field_loader.js';
import { caseOf } from './support.js';

const decoder = await SlfDecoder.create();
const { bytes, expect: [expected] } = caseOf('harmonics');
const skip = !existsSync(new URL('../../node_modules/three', import.meta.url)) && 'there is no three: npm ci in web/';

/** A loader whose worker answers nothing. */
function silentLoader() {
  return new FieldLoader({ wasm: decoder.module, worker: () => ({ postMessage() {}, terminate() {} }) });
}

/** Calls use(requests, cancelled()) while fetch() answers with a body without an end. */
async function withEndlessFetch(use) {
  const { fetch } = globalThis, requests = [];
  let cancelled = 0;
  globalThis.fetch = async (url, request) => {
    requests.push(request);
    return new Response(new ReadableStream({
      async pull(controller) {
        await new Promise((done) => setTimeout(done, 5));
        controller.enqueue(new Uint8Array(10));
      },
      cancel() { ++cancelled; },
    }));
  };
  try {
    await use(requests, () => cancelled);
  } finally {
    globalThis.fetch = fetch;
  }
}

for (const [how, giveUp] of [
  ['another file', (loader) => { loader.load(new Uint8Array(3)).catch(() => {}); }],
  ['dispose()', (loader) => loader.dispose()],
  ['a signal', (loader, abort) => abort.abort()],
])
  test(`a file that is given up by ${how} is asked for no longer`, () => withEndlessFetch(async (requests, cancelled) => {
    const loader = silentLoader(), abort = new AbortController();
    const given = loader.load('http://nowhere.test/a', {}, { signal: abort.signal });
    setTimeout(() => giveUp(loader, abort), 20);
    await assert.rejects(given, { name: 'AbortError' });
    assert.ok(requests[0].signal.aborted);
    assert.equal(cancelled(), 1);
  }));

test('headers and credentials go with the request', () => withEndlessFetch(async (requests) => {
  const loader = silentLoader(), headers = { Authorization: 'Bearer x' };
  const given = loader.load('http://nowhere.test/a', {}, { headers, credentials: 'include' });
  setTimeout(() => loader.dispose(), 10);
  await assert.rejects(given, { name: 'AbortError' });
  assert.deepEqual([requests[0].headers, requests[0].credentials], [headers, 'include']);
}));

test('of another origin a length may be that before unpacking: more or less may come', async () => {
  const { fetch } = globalThis;
  const load = async (type) => {
    globalThis.fetch = async () => Object.defineProperty(
      new Response(bytes, { headers: { 'Content-Length': String(bytes.length + 20) } }), 'type', { value: type });
    const loader = silentLoader();
    loader.decode = async () => ({ packed: {}, info: {} });
    return loader.load('http://nowhere.test/a');
  };
  try {
    assert.equal((await load('cors')).bytes, bytes.length);
    await assert.rejects(load('basic'), { kind: 'network' });
  } finally {
    globalThis.fetch = fetch;
  }
});

test('a worker whose script cannot be fetched is a matter of the network, one that stops of memory', async () => {
  for (const [event, kind] of [[{}, 'network'], [{ message: 'too much' }, 'memory']]) {
    const loader = silentLoader(), given = loader.load(bytes);
    await new Promise(setImmediate);
    loader.worker.onerror(event);
    await assert.rejects(given, { kind });
  }
});

test('the part that is decoded is the one that is asked for when the file is here', async () => {
  const loader = silentLoader(), options = { levels: 5 }, asked = [];
  loader.decode = async (part) => {
    asked.push(part);
    return { packed: {}, info: {} };
  };
  const loading = loader.load(new Blob([bytes]), {}, options);
  options.levels = 3;
  assert.deepEqual((await loading).part, { levels: 3, groups: 0, layers: 0 });
  assert.equal(asked.at(-1).levels, 3);
});

function sessionOf(create = async () => decoder, file = bytes) {
  const session = new DecodeSession(create);
  session.append(file);
  return session;
}

test('more levels, groups and layers than a file has are all of them', async () => {
  const { packed } = await sessionOf().decode({ levels: 21, groups: 4096, layers: 4 });
  assert.equal(packed.points, expected.points);
});

test('a part is refused for its own memory, and the refusal says what the file has', async () => {
  const large = caseOf('layers-four').bytes, session = sessionOf(undefined, large);
  const { levels, decodeBytes } = decoder.info(large);
  const maxMemory = decoder.preflight(large, { levels: Math.max(1, levels - 3) }).memoryBytes - 1;
  await assert.rejects(session.decode({ budget: { maxMemory, mayBeCoarser: true } }), { kind: 'too-large' });
  await assert.rejects(session.decode({ budget: { maxMemory: decodeBytes - 1 } }), { kind: 'too-large' });
  assert.equal(session.info.levels, levels);
  // which comes after:
  await assert.rejects(session.decode({ groups: 1, budget: { maxMemory: decodeBytes - 1 } }), { kind: 'no-view-maps' });
});

test('what has arrived of a file shows as soon as it has colours, and every byte is read once', async () => {
  let pushed = 0;
  const session = new DecodeSession(async () => ({
    frames() {
      const reader = decoder.frames(), { push } = reader;
      return Object.assign(reader, { push(piece) { pushed += piece.length; push.call(reader, piece); } });
    },
  }));
  session.append(bytes);
  const shown = [];
  for (let prefix = 16; prefix < bytes.length; prefix += 16) {
    const { packed, info } = await session.decode({ prefix });
    if (!packed) continue;
    assert.equal(info.complete, false);
    assert.ok(packed.partial && new Set(packed.means).size > 2);
    shown.push(packed.points);
  }
  assert.ok(shown.length > 0 && shown.every((points, i) => i === 0 || points >= shown[i - 1]));
  const { packed } = await session.decode({});
  assert.equal(packed.points, expected.points);
  assert.ok(!packed.partial);
  assert.equal(pushed, bytes.length);
});

test('a reader whose memory failed is followed by another', async () => {
  const session = sessionOf();
  await session.decode({});
  const { reader } = session;
  session.decoder = undefined; // as of a decode that trapped
  reader.release();
  assert.equal((await session.decode({ levels: 2 })).packed.levels, 2);
  assert.notEqual(session.reader, reader);
});

test('a picture that would be done later than the rest is here is not decoded', async () => {
  const { fetch } = globalThis, size = 200_000, chunk = 2000;
  const looks = async (wait, takes) => {
    globalThis.fetch = async () => new Response(new ReadableStream({
      async pull(controller) {
        if (wait) await new Promise((done) => setTimeout(done, wait));
        if ((this.sent = (this.sent ?? 0) + chunk) > size) controller.close();
        else controller.enqueue(new Uint8Array(chunk));
      },
    }), { headers: { 'Content-Length': String(size) } });
    const loader = silentLoader(), prefixes = [];
    loader.decode = async ({ prefix }) => {
      if (!prefix) return { packed: {}, info: {} };
      prefixes.push(prefix);
      await new Promise((done) => setTimeout(done, takes));
      return {};
    };
    await loader.load('http://nowhere.test/a', { field() {} });
    return prefixes;
  };
  try {
    const slow = await looks(5, 1), late = await looks(5, 400);
    assert.ok(slow.length >= 4 && slow.every((prefix, i) => i === 0 || prefix >= 2 * slow[i - 1]), `${slow}`);
    assert.equal(late.length, 1, `${late}`);
  } finally {
    globalThis.fetch = fetch;
  }
});

test('a decoder that did not arrive is asked for again, and is no fault of the file', async () => {
  let asked = 0;
  const session = sessionOf(async () => {
    if (++asked === 1) throw new SlfError('NETWORK', 'NETWORK: no answer');
    return decoder;
  });
  const refused = await session.decode({}).catch(plainError);
  assert.equal(refused.kind, 'network');
  assert.match(refused.words, /^The decoder/);
  assert.equal((await session.decode({})).packed.points, expected.points);
});

test('parse() of every loader has one decoder', { skip }, async () => {
  const { SLFLoader } = await import('../../viewer/SLFLoader.js');
  const { compile } = WebAssembly;
  let compiled = 0;
  WebAssembly.compile = (...all) => {
    ++compiled;
    return compile(...all);
  };
  try {
    for (let i = 0; i < 3; ++i) assert.equal((await new SLFLoader().parse(bytes)).packed.points, expected.points);
    assert.equal(compiled, 1);
  } finally {
    WebAssembly.compile = compile;
  }
});

test('the view of a page is that of its camera, unless the address names another', async () => {
  const { readOptions } = await import('../../viewer/options.js');
  const page = { azimuth: 30, view: { eye: [0, 0, 0] } }, view = (query) => readOptions(new URLSearchParams(query), page).view;
  assert.equal(view(''), page.view);
  assert.equal(view('azimuth=12'), null);
  assert.equal(readOptions(new URLSearchParams('background=constructor&target=1,2&mode=__proto__')).background, null);
  assert.deepEqual(readOptions(new URLSearchParams('target=1,-2,3.5')).target, [1, -2, 3.5]);
  const odd = readOptions(new URLSearchParams('levels=4.4&points=%20&zoom=%20&target=1,%20,3&autorotate=abc'));
  assert.deepEqual([odd.levels, odd.points, odd.zoom, odd.target, odd.autorotate], [4, 100, 1, null, 0]);
  const turning = (text) => readOptions(new URLSearchParams(text)).autorotate;
  assert.deepEqual(['autorotate=', 'autorotate=true', 'autorotate=0.0', 'autorotate=30'].map(turning), [12, 12, 0, 30]);
  assert.deepEqual(['1,2', '1,2,', 'a,b,c', ''].map((each) => readOptions(new URLSearchParams({ target: each })).target), [null, null, null, null]);
});
