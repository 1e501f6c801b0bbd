// SPDX-License-Identifier: Apache-2.0
// What goes wrong before the viewer: damaged files, networks, memory; a person is told, nothing is left.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { newPage, settled, skip } from './support.mjs';
import { viewerUnderTest } from './viewer_support.mjs';

const here = viewerUnderTest();

const PROBLEMS = [
  ['a damaged file', 'src=/files/damaged.slf', 'damaged'],
  ['a file that was cut', 'src=/files/cut.slf', 'damaged'],
  ['no such file', 'src=/files/none.slf', 'network'],
  ['a connection that breaks', 'src=/files/breaks.slf', 'network'],
  ['a file of another kind', 'src=/files/capture/cameras.json', 'damaged'],
  ['a server that is not there', 'src=http://127.0.0.1:9/x.slf', 'network'],
];
for (const [name, query, kind] of PROBLEMS)
  test(`${name} is said in words`, { skip }, async () => {
    const page = await here.open(query);
    assert.equal(await settled(page), `failed ${kind}`);
    assert.ok(await page.isVisible('#problem h2'));
    assert.ok((await page.textContent('#problem p')).length > 10);
    assert.deepEqual(page.wrong, []);
    await page.close();
  });

for (const name of ['stalls', 'silent'])
  test(`a server that falls silent is given up: ${name}.slf`, { skip }, async () => {
    const page = await here.open('');
    await page.evaluate((url) => {
      window.viewer.loader.stallMs = 700;
      return window.viewer.open(url, 'can');
    }, `/files/${name}.slf`);
    assert.equal(await settled(page), 'failed network');
    assert.equal(await page.textContent('#problem p'), 'The server has sent nothing for 0.7 seconds.');
    assert.deepEqual(page.wrong, []);
    await page.close();
  });

test('after a file that failed the page is as it was without one, and embedded it has no buttons', { skip }, async () => {
  const page = await here.opened('src=/files/can.slf&capture=/files/capture');
  await page.keyboard.press('g');
  await page.evaluate(() => window.viewer.open('/files/damaged.slf', 'damaged.slf'));
  assert.equal(await settled(page), 'failed damaged');
  assert.match(await page.textContent('#problem .detail'), /CHECKSUM: unit_crc/);
  assert.ok(await page.isHidden('#panel'));
  await page.click('[data-do=dismiss]');
  assert.ok(await page.isVisible('#welcome'));
  assert.equal(await page.evaluate(() => document.body.dataset.state), undefined);
  await page.close();
  const embedded = await here.open('src=/files/damaged.slf&embed');
  assert.equal(await settled(embedded), 'failed damaged');
  assert.ok(await embedded.isVisible('#problem'));
  assert.equal(await embedded.locator('button:visible').count(), 0);
  await embedded.close();
});

test('a file that takes a little too much memory is shown coarser, and the page says so', { skip }, async () => {
  const page = await here.opened('src=/files/can.slf&lang=de');
  await page.evaluate(() => {
    const { viewer } = window;
    viewer.loader.maxMemory = viewer.facts.info.decodeBytes - 1;
    return viewer.open('/files/can.slf', 'again');
  });
  assert.equal(await settled(page), 'ready');
  const { coarser, levels, slider, asked } = await page.evaluate(() => ({
    coarser: window.viewer.facts.coarser.levels,
    levels: window.viewer.facts.info.levels,
    slider: Number(document.querySelector('#levels').value),
    asked: window.viewer.options.levels,
  }));
  assert.ok(coarser >= levels - 3 && coarser < levels, `${coarser} of ${levels}`);
  assert.equal(slider, coarser);
  assert.equal(asked, 0);
  assert.match(await page.textContent('#subtitle'), new RegExp(`Speicher fehlt: ${coarser} von ${levels} Stufen`));
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('a file that takes far too much memory is refused, and can be shown coarser', { skip }, async () => {
  const page = await here.open('src=/files/can.slf');
  assert.equal(await settled(page), 'ready');
  await page.evaluate(() => {
    window.viewer.loader.maxMemory = 1 << 10;
    return window.viewer.open('/files/can.slf', 'again');
  });
  assert.equal(await settled(page), 'failed too-large');
  assert.ok(await page.isVisible('[data-do=coarser]'));
  await page.evaluate(() => {
    window.viewer.loader.maxMemory = 2 ** 31;
  });
  await page.click('[data-do=coarser]');
  await page.waitForFunction(() => document.body.dataset.state === 'ready');
  assert.ok(await page.evaluate(() => window.viewer.options.levels === window.viewer.facts.info.levels - 2));
  assert.ok(await page.isHidden('#problem'));
  await page.close();
});

for (const [name, pattern, words] of [
  ['the decoder', '**/slf.wasm', /^The decoder, a part of this page, did not arrive/],
  ['its worker', '**/decode_worker*', /^The decoder, a part of this page, did not arrive/],
])
  test(`${name} that cannot be fetched is no fault of the file`, { skip }, async () => {
    const page = await newPage(here.chrome);
    await page.route(pattern, (route) => route.abort());
    await page.goto(`${here.server.page}?src=/files/can.slf`);
    assert.equal(await settled(page), 'failed network');
    assert.match(await page.textContent('#problem p'), words);
    await page.close();
  });

test('a worker whose own script does not arrive starts from the copy of it', { skip }, async () => {
  const page = await newPage(here.chrome);
  await page.route('**/decode_worker.js', (route) => route.abort());
  await page.goto(`${here.server.page}?src=/files/can.slf`);
  assert.equal(await settled(page), 'ready');
  await page.close();
});

test('a value that is none, and names of what every object has, are as if they were not there', { skip }, async () => {
  const page = await newPage(here.chrome);
  for (const value of ['constructor', '__proto__', 'toString']) {
    const query = ['background', 'mode', 'camera', 'lang', 'scroll', 'target', 'azimuth'].map((name) => `${name}=${value}`).join('&');
    await page.goto(`${here.server.page}?src=/files/can.slf&${query}`);
    assert.equal(await settled(page), 'ready', query);
  }
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('a decoder that did not arrive for the first picture is asked for again for the next', { skip }, async () => {
  const page = await newPage(here.chrome);
  let asked = 0;
  await page.route('**/slf.wasm', (route) => (++asked === 1 ? route.abort() : route.continue()));
  await page.goto(`${here.server.page}?src=/files/slow.slf`);
  assert.equal(await settled(page), 'ready');
  assert.ok(asked > 1);
  await page.close();
});

test('without WebGL 2 the page says so', { skip }, async () => {
  const page = await newPage(here.chrome);
  await page.addInitScript(() => {
    HTMLCanvasElement.prototype.getContext = () => null;
  });
  await page.goto(`${here.server.page}?src=/files/can.slf`);
  assert.equal(await settled(page), 'failed no-webgl2');
  assert.match(await page.textContent('#problem'), /WebGL 2/);
  await page.close();
});
