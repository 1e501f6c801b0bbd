// SPDX-License-Identifier: Apache-2.0
// What a person does with the viewer: opening, turning, sliders, comparing.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { test } from 'node:test';
import { loseContext, pictureOf, psnr, settled, skip, slf } from './support.mjs';
import { slide, viewerUnderTest } from './viewer_support.mjs';

const here = viewerUnderTest();

const pose = (page) => page.evaluate(() => ({ ...window.viewer.stage.pose }));
const points = (page) => page.evaluate(() => window.viewer.stage.field.points);

test("a file of the address is shown, titled and asked for alone, from the page's own server", { skip }, async () => {
  const page = await here.opened('src=/files/can.slf&title=A%20can');
  assert.equal(await page.textContent('#title'), 'A can');
  assert.match(await page.textContent('#subtitle'), /^[\d,]+ points · 1\d\.\d kB$/);
  assert.deepEqual(
    page.asked.filter((url) => !url.startsWith(here.server.url) && !url.startsWith('data:')),
    [],
  );
  assert.equal(page.asked.filter((url) => new URL(url).pathname.startsWith('/files/')).length, 1);
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('a slow file shows coarsely before it has arrived, and whole after', { skip }, async (t) => {
  const page = await here.open('src=/files/slow.slf&background=808080');
  await page.waitForFunction(() => document.body.dataset.state === 'coarse');
  const part = Number(await page.getAttribute('#progress', 'aria-valuenow'));
  const coarse = psnr(await pictureOf(page, here.can.views[0], here.can.size), here.can.pictures[0]);
  assert.equal(await settled(page), 'ready');
  const whole = psnr(await pictureOf(page, here.can.views[0], here.can.size), here.can.pictures[0]);
  t.diagnostic(
    `first picture at ${part} % of the bytes: ${coarse.toFixed(2)} dB to that of slf render, the whole ${whole.toFixed(2)}`,
  );
  assert.ok(part < 90, `${part} %`);
  assert.ok(coarse > 12 && coarse < whole - 10 && whole >= 35);
  assert.ok(await page.isHidden('#progress'));
  await page.close();
});

test('a file can be dropped, or picked, on the page without a file', { skip }, async () => {
  const page = await here.open('');
  assert.ok(await page.isVisible('#welcome'));
  const base64 = here.can.bytes.toString('base64');
  const transfer = await page.evaluateHandle((text) => {
    const made = new DataTransfer();
    made.items.add(new File([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], 'dropped.slf'));
    return made;
  }, base64);
  await page.dispatchEvent('body', 'drop', { dataTransfer: transfer });
  assert.equal(await settled(page), 'ready');
  assert.equal(await page.evaluate(() => window.viewer.facts.name), 'dropped.slf');
  assert.ok(await page.isHidden('#welcome'));
  await page.setInputFiles('#file', { name: 'picked.slf', mimeType: 'application/octet-stream', buffer: here.can.bytes });
  await page.waitForFunction(
    () => window.viewer.facts.name === 'picked.slf' && document.body.dataset.state === 'ready',
  );
  await page.close();
});

test('mouse, wheel, touch and keys move the camera; reset brings it back', { skip }, async () => {
  const page = await here.opened();
  const start = await pose(page);
  await page.mouse.move(200, 200);
  await page.mouse.down();
  await page.mouse.move(260, 230, { steps: 3 });
  await page.waitForTimeout(150); // held still: nothing to run on
  await page.mouse.up();
  const turned = await pose(page);
  assert.ok(Math.abs(turned.azimuth - (start.azimuth - 60 * 0.35)) < 1e-6, `${turned.azimuth}`);
  assert.ok(Math.abs(turned.elevation - (start.elevation + 30 * 0.35)) < 1e-6);
  await page.mouse.wheel(0, -200);
  await page.waitForFunction((d) => window.viewer.stage.pose.distance < d, turned.distance);
  await page.focus('#stage');
  const before = await pose(page);
  await page.keyboard.press('ArrowRight');
  assert.ok(Math.abs((await pose(page)).azimuth - before.azimuth - 6) < 1e-6);
  await page.keyboard.press('Shift+ArrowUp');
  assert.notDeepEqual((await pose(page)).target, before.target);
  await page.evaluate(() => {
    const send = (type, id, x, y) =>
      document
        .getElementById('stage')
        .dispatchEvent(
          new PointerEvent(type, { pointerId: id, clientX: x, clientY: y, pointerType: 'touch', bubbles: true }),
        );
    document.getElementById('stage').setPointerCapture = () => {};
    send('pointerdown', 11, 200, 200);
    send('pointerdown', 12, 260, 200);
    send('pointermove', 12, 320, 200);
    send('pointerup', 11, 200, 200);
    send('pointerup', 12, 320, 200);
  });
  assert.ok(Math.abs((await pose(page)).distance / before.distance - 0.5) < 1e-6);
  await page.keyboard.press('r');
  assert.deepEqual(await pose(page), start);
  await page.keyboard.press('v');
  await page.keyboard.down('w');
  await page.waitForFunction(
    (was) => Math.hypot(...window.viewer.controls.eye().map((v, k) => v - was[k])) > 0.01,
    await page.evaluate(() => window.viewer.controls.eye()),
  );
  await page.keyboard.up('w');
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('layers can be chosen where a file has several, by a slider and by the address', { skip }, async () => {
  slf('encode', here.can.capture, '-o', join(here.can.dir, 'layered.slf'), '--effort', 1, '--quality-layers', 2, '--quiet');
  const page = await here.opened('src=/files/layered.slf&layers=1&background=808080');
  assert.ok(await page.evaluate(() => !document.getElementById('layers-row').hidden));
  assert.equal(await page.inputValue('#layers'), '1');
  const first = psnr(await pictureOf(page, here.can.views[0], here.can.size), here.can.pictures[0]);
  await slide(page, 'layers', 2);
  await page.waitForFunction(() => document.getElementById('status').textContent === 'Decoded.');
  const both = psnr(await pictureOf(page, here.can.views[0], here.can.size), here.can.pictures[0]);
  assert.ok(both > first + 1, `${first} and ${both} dB`);
  assert.deepEqual(page.wrong, []);
  await page.close();
  const plain = await here.opened('src=/files/can.slf');
  assert.ok(await plain.evaluate(() => document.getElementById('layers-row').hidden));
  await plain.close();
});

test('sliders change what is drawn: points, levels, groups, exposure, resolution, mean colour', { skip }, async () => {
  const page = await here.opened('src=/files/can.slf&background=808080');
  const all = await points(page),
    picture = await pictureOf(page, here.can.views[0], here.can.size);
  assert.ok(psnr(picture, here.can.pictures[0]) >= 35);
  await slide(page, 'points', 25);
  await pictureOf(page, here.can.views[0], here.can.size);
  assert.equal(await page.evaluate(() => window.viewer.stage.pipeline.statistics.discs), Math.round(all / 4));
  await slide(page, 'points', 100);
  await slide(page, 'exposure', 1);
  const brighter = await pictureOf(page, here.can.views[0], here.can.size);
  assert.ok(brighter.data.reduce((s, v) => s + v, 0) > picture.data.reduce((s, v) => s + v, 0) * 1.02);
  await slide(page, 'exposure', 0);
  assert.deepEqual((await pictureOf(page, here.can.views[0], here.can.size)).data, picture.data);
  await slide(page, 'levels', 5);
  await page.waitForFunction((n) => window.viewer.stage.field.points < n, all);
  await slide(page, 'levels', 99);
  await page.waitForFunction((n) => window.viewer.stage.field.points === n, all);
  await slide(page, 'groups', 1);
  await page.waitForFunction(
    () => window.viewer.options.groups === 1 && document.getElementById('status').textContent === 'Decoded.',
  );
  for (let i = 0; i < 50 && page.workers().length > 0; ++i) await page.waitForTimeout(100);
  assert.equal(page.workers().length, 0); // each decode had one of its own
  assert.ok(psnr(await pictureOf(page, here.can.views[0], here.can.size), picture) < 50);
  await slide(page, 'resolution', 50);
  await pictureOf(page, here.can.views[0], here.can.size);
  assert.equal(await page.evaluate(() => document.getElementById('stage').width), here.can.size / 2);
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('every control has a name, and the page can be used without a mouse', { skip }, async () => {
  const page = await here.opened();
  const nameless = await page.$$eval('button, input, select, canvas[tabindex]', (all) =>
    all
      .filter((e) => !(e.getAttribute('aria-label') || e.textContent.trim() || e.labels?.[0]?.textContent.trim()))
      .map((e) => e.outerHTML),
  );
  assert.deepEqual(nameless, []);
  await page.keyboard.press('h');
  assert.ok(await page.isVisible('dialog#help'));
  await page.keyboard.press('Escape');
  assert.ok(await page.isHidden('dialog#help'));
  await page.focus('[data-do=panel]');
  await page.keyboard.press('Enter');
  assert.ok(await page.isVisible('#panel'));
  assert.equal(await page.getAttribute('[data-do=panel]', 'aria-expanded'), 'true');
  await page.keyboard.press('Escape');
  assert.ok(await page.isHidden('#panel'));
  await page.close();
});

test('embedded there is the object alone; asked for less motion nothing turns by itself', { skip }, async () => {
  const page = await here.opened('src=/files/can.slf&embed&autorotate=30', { reducedMotion: 'reduce' });
  for (const part of ['#tools', '#caption', '#panel']) assert.ok(await page.isHidden(part), part);
  assert.equal(await page.evaluate(() => Boolean(window.viewer.spinning)), false);
  await page.close();
  const moving = await here.opened('src=/files/can.slf&embed&autorotate=30');
  const start = (await pose(moving)).azimuth;
  await moving.waitForFunction((was) => window.viewer.stage.pose.azimuth !== was, start);
  await moving.close();
});

test('high density and a new size give pictures of that many pixels', { skip }, async () => {
  const page = await here.opened('src=/files/can.slf', { deviceScaleFactor: 2, viewport: { width: 150, height: 120 } });
  const size = () => page.evaluate(() => [window.viewer.stage.canvas.width, window.viewer.stage.canvas.height].join());
  await page.waitForFunction(() => window.viewer.stage.canvas.width === 300);
  assert.equal(await size(), '300,240');
  await page.setViewportSize({ width: 120, height: 160 });
  await page.waitForFunction(() => window.viewer.stage.canvas.width === 240);
  assert.equal(await size(), '240,320');
  await page.close();
});

test('a lost context comes back with the same picture', { skip }, async () => {
  const page = await here.opened('src=/files/can.slf&background=808080');
  const picture = await pictureOf(page, here.can.views[1], here.can.size);
  await loseContext(page);
  await page.waitForFunction(() => document.getElementById('status').textContent === 'The graphics context is back.');
  assert.deepEqual((await pictureOf(page, here.can.views[1], here.can.size)).data, picture.data);
  await page.close();
});

test('through a camera of the capture the photograph lies beside the rendering, with its PSNR', { skip }, async (t) => {
  const page = await here.opened('src=/files/can.slf&capture=/files/capture&camera=2');
  await page.waitForFunction(() => window.viewer.facts.psnr !== undefined);
  const value = await page.evaluate(() => window.viewer.facts.psnr);
  t.diagnostic(`${value.toFixed(2)} dB within the object`);
  assert.ok(value > 20 && value < 60, `${value} dB`);
  assert.match(await page.textContent('#psnr'), /PSNR within the object: \d\d\.\d\d dB/);
  assert.ok(await page.isVisible('#photograph'));
  await slide(page, 'divider', 80);
  assert.equal(await page.evaluate(() => document.getElementById('compare').style.getPropertyValue('--at')), '80%');
  await page.evaluate(() => {
    const camera = window.viewer.comparison.cameras[3],
      load = camera.photograph;
    const arrived = new Promise((go) => (window.arrive = go));
    camera.photograph = () => arrived.then(() => load.call(camera));
  });
  await page.keyboard.press(']');
  await page.waitForFunction(() => document.getElementById('cameras').value === '3');
  await page.keyboard.press('c');
  await page.evaluate(() => window.arrive());
  await page.waitForFunction(() => document.getElementById('psnr').textContent.startsWith('PSNR'));
  assert.ok(await page.isHidden('#compare'), 'put away before the photograph came, it stays away');
  assert.deepEqual(page.wrong, []);
  await page.close();
});
