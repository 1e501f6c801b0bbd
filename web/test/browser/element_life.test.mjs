// SPDX-License-Identifier: Apache-2.0
// <slf-viewer>: what addresses may say of it, and what becomes of it in and out of the page.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { elementPages, skip, state, viewer } from './element_support.mjs';
import { viewerUnderTest } from './viewer_support.mjs';

const here = viewerUnderTest();
const pageOf = elementPages(here);

test('an address chooses a view and nothing else, and one that is none harms nothing', { skip }, async () => {
  const page = await pageOf('chosen', viewer('a', 'title="Ours" azimuth="10"'));
  await page.goto(`${page.address}#a?src=/files/none.slf&title=Theirs&poster=/files/none.png&memory=16&azimuth=77`);
  await page.reload();
  assert.equal(await state(page, 'a'), 'ready');
  const said = await page.evaluate(() => [document.getElementById('a').view.azimuth, document.getElementById('a').shadowRoot.textContent.includes('Theirs')]);
  assert.deepEqual(said, ['77', false]);
  await page.goto(`${page.address}#100%`);
  await page.reload();
  assert.equal(await state(page, 'a'), 'ready');
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('a view that was turned round and round, with a look of its own, is found again', { skip }, async () => {
  const page = await pageOf('again', viewer('a'));
  await state(page, 'a');
  const said = await page.evaluate(async () => {
    const a = document.getElementById('a'), exposures = [];
    a.viewer.controls.pose.azimuth = 844.5;
    const view = a.view;
    a.view = { ...view, exposure: 1, mode: 'fly' };
    exposures.push(a.viewer.stage.look.exposure);
    for (let i = 0; i < 3; ++i) {
      await a.sleep();
      await (await a.wake()).opening;
      exposures.push(a.viewer.stage.look.exposure);
    }
    return { azimuth: view.azimuth, again: a.view.azimuth, mode: a.view.mode, exposures };
  });
  assert.deepEqual(said, { azimuth: '124.5', again: '124.5', mode: 'fly', exposures: [1, 1, 1, 1] });
  await page.close();
});

test('a viewer that opens a file before it is in the page, or is taken out while it changes, shows when it is back', { skip }, async () => {
  const page = await pageOf('late', viewer('a', 'loading="eager"'));
  await state(page, 'a');
  await page.evaluate(async () => {
    const b = document.createElement('slf-viewer'), a = document.getElementById('a');
    b.id = 'b';
    await b.open(await (await fetch('/files/can.slf')).blob(), 'own.slf');
    document.querySelector('main').append(b);
    a.setAttribute('src', '/files/can.slf?again');
    a.remove();
    await new Promise((done) => setTimeout(done, 500));
    document.querySelector('main').append(a);
  });
  assert.equal(await state(page, 'b'), 'ready');
  assert.equal(await state(page, 'a'), 'ready');
  await page.close();
});
