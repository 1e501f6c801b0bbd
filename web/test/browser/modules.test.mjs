// SPDX-License-Identifier: Apache-2.0
// The modules by themselves, in a page of a server: the decoding worker, the loader and the object of three.js.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { newPage, skip } from './support.mjs';
import { viewerUnderTest } from './viewer_support.mjs';

const here = viewerUnderTest();

test('a worker gives an array that is named twice, refuses what it does not know, and ends', { skip }, async () => {
  const page = await newPage(here.chrome);
  await page.goto(here.server.page);
  const said = await page.evaluate(async () => {
    const { SlfWorker } = await import(new URL('../slf_worker.js', document.baseURI));
    const bytes = await (await fetch('/files/can.slf')).arrayBuffer();
    const worker = await SlfWorker.create();
    const outcome = (call) =>
      call.then(
        (field) => field.positions?.length === 3 * field.points,
        (error) => error.code,
      );
    const decode = (arrays) => outcome(worker.decode(bytes, {}, { arrays }));
    const all = [await decode(['positions', 'positions']), await decode(['nonsense']), await decode(['toString'])];
    const stream = await worker.open('/files/can.slf');
    all.push(await outcome(stream.decode()));
    await stream.close();
    all.push(await outcome(stream.decode()));
    worker.terminate();
    return [...all, await outcome(worker.decode(bytes))];
  });
  assert.deepEqual(said, [true, 'INVALID_ARGUMENT', 'INVALID_ARGUMENT', true, 'INVALID_ARGUMENT', 'ABORTED']);
  await page.close();
});

test('stream() of the loader sends the headers that load() sends', { skip }, async () => {
  const page = await newPage(here.chrome),
    sent = [];
  await page.goto(`${here.server.three}?src=/files/can.slf`);
  await page.waitForFunction(() => window.ready);
  page.on('request', (request) => {
    if (request.url().endsWith('can.slf')) sent.push(request.headers().authorization);
  });
  await page.evaluate(async () => {
    const { SLFLoader } = await import(new URL('SLFLoader.js', document.baseURI));
    const loader = new SLFLoader().setRequestHeader({ Authorization: 'Bearer x' });
    await loader.loadAsync('/files/can.slf');
    await loader.stream('/files/can.slf', () => {});
  });
  assert.deepEqual(sent, ['Bearer x', 'Bearer x']);
  await page.close();
});

test('a light field that the device cannot hold fails alike in every frame, and leaves no programs', { skip }, async () => {
  const page = await newPage(here.chrome);
  await page.goto(`${here.server.three}?src=/files/can.slf`);
  await page.waitForFunction(() => window.ready);
  const { kinds, left } = await page.evaluate(async () => {
    const { SurfaceLightField } = await import(new URL('surface_light_field.js', document.baseURI));
    const { field, scene, renderer, camera, THREE } = window;
    const large = new SurfaceLightField({ ...field.packed, rows: 1e6 }),
      view = camera ?? new THREE.PerspectiveCamera(30, 1, 0.01, 100);
    const { createProgram, deleteProgram } = WebGL2RenderingContext.prototype;
    let left = 0;
    WebGL2RenderingContext.prototype.createProgram = function () {
      ++left;
      return createProgram.call(this);
    };
    WebGL2RenderingContext.prototype.deleteProgram = function (program) {
      --left;
      return deleteProgram.call(this, program);
    };
    const kinds = [0, 1, 2].map(() => {
      try {
        large.draw(renderer, scene, view);
      } catch (error) {
        return error.kind;
      }
    });
    large.dispose();
    return { kinds, left };
  });
  assert.deepEqual(kinds, ['too-large', 'too-large', 'too-large']);
  assert.equal(left, 0);
  await page.close();
});

test('every error of the loader has its kind, and a decoder that is not there is named', { skip }, async () => {
  const page = await newPage(here.chrome);
  await page.goto(`${here.server.three}?src=/files/can.slf`);
  await page.waitForFunction(() => window.ready);
  const said = await page.evaluate(async () => {
    const { SLFLoader } = await import(new URL('SLFLoader.js', document.baseURI));
    const met = (file, parts) => new SLFLoader(undefined, parts).loadAsync(file).then(() => ['loaded'], (error) => [error.kind, error.detail]);
    const asked = [], locateFile = (name) => (asked.push(name), '/files/none.wasm');
    return {
      missing: await met('/files/none.slf'),
      damaged: await met('/files/damaged.slf'),
      decoder: await met('/files/can.slf', { locateFile }),
      asked,
      worker: await met('/files/can.slf', { worker: () => Promise.reject(new Error('none')) }),
      own: await met('/files/can.slf', { wasm: new URL('../slf.wasm', document.baseURI), locateFile }),
    };
  });
  assert.deepEqual([said.missing[0], said.damaged[0], said.decoder[0], said.own[0]], ['network', 'damaged', 'network', 'loaded']);
  assert.match(said.decoder[1], /none\.wasm is not there .* locateFile/);
  assert.deepEqual([...new Set(said.asked)], ['slf.wasm']);
  assert.deepEqual(said.worker, ['network', 'none']);
  await page.close();
});
