// SPDX-License-Identifier: Apache-2.0
// What the viewer does while files arrive, and when contexts, files and photographs come and go.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { pictureOf, psnr, settled, skip, slf } from './support.mjs';
import { slide, viewerUnderTest } from './viewer_support.mjs';

const here = viewerUnderTest();

test('a slider that moves while a file arrives holds for what comes, and nothing is said to be wrong', { skip }, async () => {
  const page = await here.open('src=/files/slow.slf');
  await page.waitForFunction(() => document.body.dataset.state === 'coarse');
  await slide(page, 'levels', 4);
  assert.equal(await settled(page), 'ready');
  assert.ok(await page.isHidden('#problem'));
  assert.equal(await page.inputValue('#levels'), '4');
  assert.equal(await page.evaluate(() => window.viewer.stage.field.levels), 4);
  await page.evaluate(() => void window.viewer.open('/files/can.slf', 'again'));
  await slide(page, 'levels', 5); // the worker has nothing yet, or is decoding the part before
  await page.waitForFunction(() => window.viewer.stage.field?.levels === 5);
  assert.equal(await settled(page), 'ready');
  assert.ok(await page.isHidden('#problem'));
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('levels that were chosen for a finer file show all of a coarser one', { skip }, async () => {
  const page = await here.opened('src=/files/can.slf&levels=21&groups=99&layers=4');
  assert.ok(await page.evaluate(() => window.viewer.stage.field.levels === window.viewer.facts.info.levels));
  await page.close();
});

/** Loses the graphics context of the stage; back(): gives it back. */
async function loseContext(page) {
  await page.evaluate(async () => {
    const { gl, canvas } = window.viewer.stage;
    window.context = gl.getExtension('WEBGL_lose_context');
    const gone = new Promise((done) => canvas.addEventListener('webglcontextlost', done, { once: true }));
    window.context.loseContext();
    await gone;
    await new Promise((done) => setTimeout(done, 200)); // the event is over: now it may come back
  });
  return async () => {
    await page.evaluate(() => window.context.restoreContext());
    await page.waitForFunction(() => document.getElementById('status').textContent === 'The graphics context is back.');
  };
}

test('a context that is lost before a file is opened, or while it arrives, shows it when it is back', { skip }, async () => {
  const sound = await here.opened('src=/files/can.slf&background=808080');
  const { data } = await pictureOf(sound, here.can.views[1], here.can.size);
  await sound.close();
  const page = await here.open('background=808080');
  for (const file of ['can.slf', 'slow.slf']) {
    let back;
    if (file === 'can.slf') back = await loseContext(page);
    await page.evaluate((url) => {
      window.opened = window.viewer.open(url, 'can');
    }, `/files/${file}`);
    if (file === 'slow.slf') {
      await page.waitForFunction(() => document.body.dataset.state === 'coarse');
      back = await loseContext(page);
      await back(); // and what is on its way goes on
    }
    assert.equal(await settled(page), 'ready', file);
    await page.evaluate(() => window.opened);
    if (file === 'can.slf') await back();
    assert.ok(await page.isHidden('#problem'), file);
    assert.deepEqual((await pictureOf(page, here.can.views[1], here.can.size)).data, data, file);
  }
  assert.deepEqual(page.wrong, []);
  await page.close();
});

/** Drops files on the viewer, without waiting for what they become. */
const drop = (page, files) =>
  page.evaluate((all) => {
    const made = all.map(([name, base64]) => new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], name));
    (window.drops ??= []).push(window.viewer.wiring.take(made));
  }, files);
const CAMERA = { image: 'none.png', width: 8, height: 8, K: [[8, 0, 4], [0, 8, 4], [0, 0, 1]] };
const CAMERAS = { cameras: [{ ...CAMERA, R: [[1, 0, 0], [0, 1, 0], [0, 0, 1]], t: [0, 0, 3] }] };
const CAMERAS_FILE = ['cameras.json', Buffer.from(JSON.stringify(CAMERAS)).toString('base64')];

test('a capture that was dropped with one file is not laid on another', { skip }, async () => {
  const page = await here.open(''),
    can = here.can.bytes.toString('base64');
  await drop(page, [['first.slf', can], CAMERAS_FILE]);
  await drop(page, [['second.slf', can]]);
  await page.evaluate(() => Promise.all(window.drops));
  assert.equal(await page.evaluate(() => window.viewer.facts.name), 'second.slf');
  assert.ok(await page.isHidden('#photographs'));
  await page.close();
});

test('title, capture and camera of an address are of its file, not of the next', { skip }, async () => {
  const page = await here.opened('src=/files/can.slf&title=A%20can&capture=/files/capture&camera=2');
  await page.waitForFunction(() => window.viewer.facts.psnr !== undefined);
  await drop(page, [['a_jug.slf', here.can.bytes.toString('base64')]]);
  await page.evaluate(() => Promise.all(window.drops));
  assert.equal(await page.evaluate(() => window.viewer.comparison.cameras.length), 0);
  for (const gone of ['#photographs', '#compare', '[data-do=compare]']) assert.ok(await page.isHidden(gone), gone);
  assert.notEqual(await page.textContent('#title'), 'A can');
  await page.close();
});

test('a camera whose lens bends lines has its photograph, and no PSNR', { skip }, async () => {
  const page = await here.opened('src=/files/can.slf&capture=/files/capture');
  await page.waitForFunction(() => window.viewer.comparison.cameras.length > 0);
  const flags = await page.evaluate(async () => {
    const { droppedCapture } = await import(new URL('capture.js', document.baseURI));
    const frame = { file_path: 'a.png', transform_matrix: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 3]] };
    const read = async (lens) => {
      const text = JSON.stringify({ w: 8, h: 8, fl_x: 8, frames: [frame], ...lens });
      return (await droppedCapture([new File([text], 'transforms.json')]))[0].distorted;
    };
    return [await read({}), await read({ k1: 0, p2: 0 }), await read({ k2: 0.01 })];
  });
  assert.deepEqual(flags, [false, false, true]);
  await page.evaluate(() => {
    window.viewer.comparison.cameras[1].distorted = true;
    return window.viewer.comparison.lookThrough(1);
  });
  assert.match(await page.textContent('#psnr'), /no PSNR/);
  assert.ok(await page.isVisible('#photograph'));
  await page.close();
});

test('a photograph that is missing is said to be, and is compared with nothing', { skip }, async () => {
  const page = await here.opened();
  await drop(page, [CAMERAS_FILE]);
  await page.evaluate(() => Promise.all(window.drops));
  await page.evaluate(() => window.viewer.comparison.lookThrough(0));
  assert.match(await page.textContent('#psnr'), /cannot be fetched.*none\.png/);
  await page.keyboard.press('c');
  assert.ok(await page.isHidden('#compare'));
  assert.deepEqual(page.wrong, []);
  await page.close();
});
