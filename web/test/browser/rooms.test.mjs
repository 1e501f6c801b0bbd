// SPDX-License-Identifier: Apache-2.0
// Sessions of WebXR, by an emulated headset (iwer): what its eyes see from where they are, what stands on a floor.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { existsSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { launch, makeCan, newPage, pictureOf, psnr, rendered, serve, settled, skip as lacking, slf, web } from './support.mjs';

const iwer = join(web, 'node_modules/iwer/build/iwer.min.js');
const skip = lacking || (!existsSync(iwer) && 'skipped: there is no iwer (npm ci in web/)');
const SIDE = 200, // pixels of a picture
  FOV = 30, // degrees
  AWAY = 0.95; // metres to the middle of a thing that is half a metre across
let can, server, chrome;

before(async () => {
  if (skip) return;
  can = makeCan(SIDE);
  server = await serve({ files: can.dir });
  chrome = await launch();
});
after(async () => {
  await chrome?.close();
  server?.close();
});

/** Runs in the page before all else: a headset, and a floor for its rays. */
function installHeadset([modes, fovy]) {
  const { IWER } = window;
  const headset = (window.headset = new IWER.XRDevice({ ...IWER.metaQuest3, supportedSessionModes: modes }, { stereoEnabled: false, ipd: 0, fovy }));
  headset.installRuntime({ forceInstall: true });
  headset.installSEM(class {
    environmentCanvas = document.createElement('canvas');
    render() {}
    /** Where a ray, along -z of a matrix, meets y = 0. */
    computeHitTestResults(m) {
      const along = m[13] / m[9];
      if (!(along > 0)) return [];
      return [[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, m[12] - along * m[8], 0, m[14] - along * m[10], 1]];
    }
  });
}

async function pageWithHeadset(address, { modes = ['inline', 'immersive-vr', 'immersive-ar'], fov = FOV } = {}) {
  const page = await newPage(chrome, { viewport: { width: SIDE, height: SIDE } });
  await page.addInitScript({ path: iwer });
  await page.addInitScript(`(${installHeadset})(${JSON.stringify([modes, (fov * Math.PI) / 180])})`);
  await page.goto(address);
  assert.equal(await settled(page), 'ready');
  return page;
}

/** Six levels: headsets draw all the time, here by the processor. */
const viewerPage = (more = '') => `${server.page}?src=/files/can.slf&azimuth=20&levels=6${more}`;
const shown = (page, action) => page.waitForSelector(`[data-do=${action}]:not([hidden])`, { state: 'attached' });

async function enter(page, action) {
  await shown(page, action);
  await page.evaluate(() => Object.assign(window.viewer.stage, { adapt() {}, scale: 1 })); // however slow frames are here
  await page.evaluate((each) => document.querySelector(`[data-do=${each}]`).click(), action); // iwer's canvas lies above
  await page.waitForSelector(`[data-do=${action}][aria-pressed=true]`, { state: 'attached' });
  await nextFrames(page);
}

async function leave(page) {
  const home = await page.evaluateHandle(() => document.querySelector('main'));
  await page.evaluate(() => window.headset.activeSession.end());
  await page.waitForSelector('[data-do$=r][aria-pressed=true]', { state: 'detached' });
  await home.evaluate((main) => main.prepend(document.getElementById('stage'))); // iwer puts it behind the others
}

/** Not within a session: Chromium takes a minute to close a page that goes on drawing. */
async function closed(page) {
  await page.evaluate(() => window.headset?.activeSession?.end());
  await page.close();
}

const nextFrames = (page) =>
  page.evaluate(() => new Promise((done) => {
    const session = window.headset.activeSession, again = (left) => (left ? session.requestAnimationFrame(() => again(left - 1)) : done());
    again(3);
  }));

/** Moves and turns the head, degrees, to the left and up. */
const look = (page, position, left = 0, up = 0) =>
  page.evaluate(([at, y, x]) => {
    window.headset.position.set(...at);
    window.headset.quaternion.set(Math.cos(y) * Math.sin(x), Math.sin(y) * Math.cos(x), -Math.sin(y) * Math.sin(x), Math.cos(y) * Math.cos(x));
  }, [position, (left * Math.PI) / 360, (up * Math.PI) / 360]).then(() => nextFrames(page));

/** What the eyes see. @returns {{width, height, data, alpha}} RGB, and alpha */
async function seen(page) {
  const rgba = await page.evaluate(() => new Promise((done) => {
    const session = window.headset.activeSession, { gl } = window.viewer.stage;
    session.requestAnimationFrame(() => session.requestAnimationFrame(() => {
      const { width, height } = gl.canvas, out = new Uint8Array(4 * width * height);
      gl.bindFramebuffer(gl.FRAMEBUFFER, null);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, out);
      done([...out]);
    }));
  }));
  const data = Buffer.alloc(3 * SIDE * SIDE), alpha = Buffer.alloc(SIDE * SIDE);
  for (let y = 0; y < SIDE; ++y)
    for (let x = 0; x < SIDE; ++x) {
      const from = 4 * ((SIDE - 1 - y) * SIDE + x), to = y * SIDE + x;
      data.set(rgba.slice(from, from + 3), 3 * to);
      alpha[to] = rgba[from + 3];
    }
  return { width: SIDE, height: SIDE, data, alpha };
}

/** Columns that the object's middle is right of the middle of columns first .. first + width - 1. */
function columnOf({ alpha }, first = 0, width = SIDE) {
  let sum = 0, count = 0;
  for (let y = 0; y < SIDE; ++y)
    for (let x = 0; x < width; ++x)
      if (alpha[y * SIDE + first + x] > 127) {
        sum += x + 0.5 - width / 2;
        ++count;
      }
  assert.ok(count > 100, 'it is seen');
  return sum / count;
}

/** Metres between a fitting orbit's eye and the middle; the object's radius is a quarter. */
const orbitDistance = (page) =>
  page.evaluate(() => {
    const { field } = window.viewer.stage;
    return (1.03 * (field.radius + field.step) / Math.sin(Math.PI / 12)) * (0.25 / field.radius);
  });

test('who walks around it sees what slf render shows from there', { skip }, async (t) => {
  const page = await pageWithHeadset(viewerPage('&background=808080'));
  await enter(page, 'vr');
  const far = await orbitDistance(page);
  for (const [around, up] of [[0, 0], [72, 10], [200, 40]]) {
    const [a, e] = [around, up].map((v) => (v * Math.PI) / 180);
    await look(page, [far * Math.sin(a) * Math.cos(e), 1.6 + far * Math.sin(e), -AWAY + far * Math.cos(a) * Math.cos(e)], around, -up);
    const value = psnr(await seen(page), rendered(can.file, { azimuth: 20 + around, elevation: up }, SIDE, '--levels', 6));
    t.diagnostic(`${around} degrees around, ${up} up: ${value.toFixed(2)} dB`);
    assert.ok(value >= 35, `${around} ${up}: ${value} dB`);
  }
  assert.deepEqual(page.wrong, []);
  await closed(page);
});

test('two eyes see it as far apart as its distance says', { skip }, async () => {
  const page = await pageWithHeadset(viewerPage('&background=transparent'), { fov: 60 });
  await page.evaluate(() => Object.assign(window.headset, { stereoEnabled: true, ipd: 0.063 }));
  await enter(page, 'vr');
  const picture = await seen(page);
  const apart = columnOf(picture, 0, SIDE / 2) - columnOf(picture, SIDE / 2, SIDE / 2);
  const expected = (SIDE / 2 / Math.tan(Math.PI / 6)) * (0.063 / AWAY);
  assert.ok(Math.abs(apart - expected) < 0.1 * expected, `${apart} columns, not ${expected}`);
  await closed(page);
});

test('it stands on the floor that is looked at, stays where a trigger leaves it, and the room shows around it', { skip }, async (t) => {
  const page = await pageWithHeadset(viewerPage('&background=black'), { fov: 60 });
  await enter(page, 'ar');
  assert.deepEqual(await Promise.all(['#caption', '[data-do=help]', '[data-do=ar]'].map((each) => page.isHidden(each))), [true, true, false]);
  await look(page, [0, 1.6, 0], 0, -45);
  const placed = await seen(page);
  assert.equal(placed.alpha[0], 0);
  await look(page, [0.5, 1.6, 0], 0, -45);
  assert.ok(Math.abs(columnOf(await seen(page)) - columnOf(placed)) < 2, 'it follows');
  const trigger = (value) => page.evaluate((v) => window.headset.controllers.right.updateButtonValue('trigger', v), value).then(() => nextFrames(page));
  await trigger(1);
  await trigger(0);
  await look(page, [1, 1.6, 0], 0, -45);
  assert.ok(columnOf(await seen(page)) < columnOf(placed) - 20, 'it stays');
  await leave(page);
  // The same from the page: the axis of the view meets the middle of the lowest side.
  await page.evaluate(() => {
    const { stage, controls } = window.viewer, { packed, field } = stage;
    assertUp(field.up);
    const target = [field.centre[0], field.centre[1], packed.box[0][2]];
    controls.pose = stage.pose = { target, distance: 1.6 * Math.SQRT2 * 2 * field.radius / 0.5, azimuth: 20, elevation: 45, fov: 60 };
    function assertUp(up) { if (up !== '+z') throw new Error(up); }
  });
  const value = psnr(placed, await pictureOf(page, null, SIDE));
  t.diagnostic(`${value.toFixed(2)} dB`);
  assert.ok(value >= 40, `${value} dB`);
  assert.deepEqual(page.wrong, []);
  await closed(page);
});

test('a stick turns it; after the session the page goes on where it was turned to', { skip }, async () => {
  const page = await pageWithHeadset(viewerPage());
  const azimuth = () => page.evaluate(() => window.viewer.controls.pose.azimuth);
  await enter(page, 'vr');
  assert.equal(await azimuth(), 20);
  await page.evaluate(() => window.headset.controllers.right.updateAxes('thumbstick', 1, 0));
  await page.waitForFunction(() => window.viewer.controls.pose.azimuth < 0);
  await page.evaluate(() => window.headset.controllers.right.updateAxes('thumbstick', 0, 0));
  await leave(page);
  assert.equal(await page.getAttribute('[data-do=vr]', 'aria-pressed'), 'false');
  const frames = () => page.evaluate(() => Number(document.body.dataset.frame));
  const before = await frames();
  await page.keyboard.press('r');
  await page.waitForFunction((n) => Number(document.body.dataset.frame) > n, before);
  assert.equal(await azimuth(), 20);
  assert.deepEqual(page.wrong, []);
  await closed(page);
});

test('buttons show what a device has, and its code is fetched there alone', { skip }, async () => {
  const none = await newPage(chrome);
  await none.goto(viewerPage());
  assert.equal(await settled(none), 'ready');
  const vr = await pageWithHeadset(viewerPage(), { modes: ['inline', 'immersive-vr'] });
  await shown(vr, 'vr');
  assert.ok(await vr.isHidden('[data-do=ar]'));
  assert.ok(await none.isHidden('[data-do=vr]'));
  const fetched = (page) => page.asked.some((url) => url.endsWith('/xr.js'));
  assert.deepEqual([fetched(none), fetched(vr)], [false, true]);
  await vr.evaluate(() => (navigator.xr.requestSession = () => Promise.reject(new Error('no'))));
  await vr.click('[data-do=vr]');
  await vr.waitForSelector('#hint.shown');
  assert.equal(await vr.textContent('#hint'), 'The room cannot be shown.');
  assert.deepEqual([none.wrong, vr.wrong], [[], []]);
  await closed(none);
  await closed(vr);
});

test('<slf-viewer> and the page of slf html go into a room and come out', { skip }, async (t) => {
  writeFileSync(join(can.dir, 'element.html'), `<!doctype html><body data-state="ready">
<slf-viewer id="a" src="/files/can.slf" loading="eager" levels="6"></slf-viewer>
<script type="module" src="/some/path/web/viewer/slf_viewer.js"></script>`);
  const page = await pageWithHeadset(`${server.url}/files/element.html`);
  await page.waitForFunction(() => document.getElementById('a').state === 'ready');
  const told = await page.evaluate(async () => {
    const a = document.getElementById('a'), said = [];
    for (const type of ['xrstart', 'xrend']) a.addEventListener(type, (event) => said.push(`${type} ${event.detail.mode}`));
    await a.toggleRoom('ar');
    await a.toggleRoom('ar');
    return said;
  });
  assert.deepEqual(told, ['xrstart immersive-ar', 'xrend immersive-ar']);
  await closed(page);
  const file = join(can.dir, 'page.html');
  try {
    slf('html', can.file, '-o', file, '--quiet');
  } catch (error) {
    if (error.status !== 6) throw error;
    return t.skip('skipped: slf was built before web/dist/one_file.html');
  }
  const one = await pageWithHeadset(pathToFileURL(file).href);
  await enter(one, 'vr');
  assert.ok((await seen(one)).data.some((v) => v > 60));
  assert.deepEqual(one.wrong, []);
  await closed(one);
});
