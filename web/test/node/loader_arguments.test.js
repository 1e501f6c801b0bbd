// SPDX-License-Identifier: Apache-2.0
// What a caller of the three.js loader gives and is none is said as that, and no file is called damaged for it.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { existsSync } from 'node:fs';
import { caseOf } from './support.js';
import '../../slf_node.js';

const skip = !existsSync(new URL('../../node_modules/three', import.meta.url)) && 'there is no three: npm ci in web/';
const { SLFLoader } = skip ? {} : await import('../../viewer/SLFLoader.js');
const { ViewerError } = await import('../../viewer/packed_field.js');
const { plainError } = await import('../../viewer/decode_session.js');
const { bytes, expect: [{ points }] } = caseOf('harmonics');

test('maxMemory is a number from 0 on, and Infinity is no limit', { skip }, async () => {
  const loader = new SLFLoader();
  for (const refused of [-1, NaN, -Infinity, '1e9', null, undefined])
    assert.throws(() => { loader.maxMemory = refused; }, { name: 'RangeError', message: /SLFLoader\.maxMemory/ }, String(refused));
  assert.equal(loader.maxMemory, 2 ** 31, 'as it was');
  for (const given of [Infinity, 1e300, 2 ** 33, 1.5e9 + 0.5]) {
    loader.maxMemory = given;
    assert.equal(loader.maxMemory, given);
    assert.equal((await loader.parse(bytes)).packed.points, points, String(given));
    assert.equal((await loader.parse(caseOf('frames-attributes').bytes)).frames, 3, String(given));
  }
  for (const few of [0, 0.5, 10]) {
    loader.maxMemory = few;
    await assert.rejects(loader.parse(bytes), { kind: 'too-large' });
  }
});

test('levels, groups and layers are whole numbers, and more than there are is all', { skip }, async () => {
  const loader = new SLFLoader();
  for (const name of ['levels', 'groups', 'layers'])
    for (const refused of [-1, 1.5, NaN, Infinity, '3'])
      assert.throws(() => loader.setPart({ [name]: refused }), { name: 'RangeError', message: new RegExp(`setPart.*${name}`) });
  for (const refused of [null, undefined, 3]) assert.throws(() => loader.setPart(refused), { name: 'TypeError', message: /setPart/ });
  assert.equal((await loader.setPart({ levels: 99, groups: 99, layers: 99 }).parse(bytes)).packed.points, points);
});

test('parse() takes an ArrayBuffer or a view of one', { skip }, async () => {
  for (const refused of [null, undefined, 'abc', 5, {}, [...bytes]])
    await assert.rejects(new SLFLoader().parse(refused), { name: 'TypeError', message: /SLFLoader\.parse/ }, String(refused));
  const own = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
  for (const given of [own, new DataView(own), bytes]) assert.equal((await new SLFLoader().parse(given)).packed.points, points);
});

test('what loads in a worker says where there is none, and what is no address', { skip }, async () => {
  for (const load of [(loader) => loader.loadAsync(new Blob([bytes])), (loader) => loader.stream('http://localhost/a.slf', () => {})]) {
    await assert.rejects(load(new SLFLoader()), { name: 'TypeError', message: /no Worker here.*parse\(\)/ });
    await assert.rejects(load(new SLFLoader(undefined, { worker: 5 })), { name: 'TypeError', message: /SLFLoader\.worker/ });
  }
  const loader = new SLFLoader(undefined, { worker: () => assert.fail('it was started') });
  for (const refused of [undefined, null, 5, {}]) {
    await assert.rejects(loader.loadAsync(refused), { name: 'TypeError', message: /no address/ });
    await assert.rejects(loader.stream(refused, () => {}), { name: 'TypeError', message: /no address/ });
  }
  await assert.rejects(loader.stream('a.slf'), { name: 'TypeError', message: /onCoarse/ });
});

test('a decoder that is none is missing: no file is damaged', { skip }, async () => {
  for (const parts of [{ wasm: 5 }, { wasm: 'no address' }, { locateFile: '/parts/' }])
    await assert.rejects(new SLFLoader(undefined, parts).parse(bytes), (error) => error instanceof ViewerError
      && error.kind === 'network' && error.detail.includes(Object.keys(parts)[0]));
  assert.equal(plainError({ code: 'OUT_OF_RANGE', message: '' }).kind, 'damaged');
});
