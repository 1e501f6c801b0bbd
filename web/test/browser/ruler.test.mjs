// SPDX-License-Identifier: Apache-2.0
// The distance of two points and the bar of scale, and notes of a file's own metadata.
import assert from 'node:assert/strict';
import { before, test } from 'node:test';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { settled, skip, slf } from './support.mjs';
import { viewerUnderTest } from './viewer_support.mjs';

const here = viewerUnderTest();
const METRES = 0.05; // of a unit of metric.slf
const NOTES = { version: 1, annotations: [{ at: [0, 0, 0.5], title: 'Middle', text: 'a < b' }] };

before(() => {
  if (skip) return;
  const { dir, capture } = here.can;
  writeFileSync(join(dir, 'own.json'), JSON.stringify(NOTES));
  const quick = ['--effort', 1, '--grid-bits', 7, '--quiet'];
  slf('encode', capture, '-o', join(dir, 'metric.slf'), '--metres-per-unit', METRES, '--notes', join(dir, 'own.json'), ...quick);
});

const level = (file, more = '') => `src=/files/${file}&azimuth=0&elevation=0${more}`;
const click = (page, right, down) => page.mouse.click(240 + right, 240 + down);
const length = (page) => page.textContent('#length');

/** Metres of so many pixels on the wall of the can that is nearest. */
const onTheWall = (page, pixels) =>
  page.evaluate((count) => {
    const { pose, packed, canvas } = window.viewer.stage,
      depth = pose.distance - packed.size[0] / 2;
    return (window.viewer.metres * count * 2 * depth * Math.tan((pose.fov * Math.PI) / 360)) / Math.min(canvas.clientWidth, canvas.clientHeight);
  }, pixels);

test('two clicks measure the object in metres, and the mark turns with it', { skip }, async () => {
  const page = await here.opened(level('metric.slf'));
  await page.evaluate(() => (window.viewer.emit = (name, detail) => name === 'measure' && (window.measured = detail)));
  await page.click('[data-do=measure]');
  await click(page, 0, -40);
  assert.ok(await page.isHidden('#length'));
  await click(page, 0, 40);
  await page.waitForFunction(() => !document.getElementById('ruler').hidden);
  const { metres, units } = await page.evaluate(() => window.measured), wanted = await onTheWall(page, 80);
  assert.ok(Math.abs(metres - wanted) < 0.03 * wanted, `${metres} for ${wanted}`);
  assert.ok(Math.abs(metres - METRES * units) < 1e-12);
  assert.equal(await length(page), await page.evaluate(async (m) => (await import('./ruler.js')).lengthText(m, 1), metres));
  const left = () => page.evaluate(() => parseFloat(document.getElementById('length').style.left));
  assert.ok(Math.abs((await left()) - 240) < 6);
  await page.evaluate(() => window.viewer.controls.turn(30, 0));
  await page.waitForFunction(() => Math.abs(parseFloat(document.getElementById('length').style.left) - 240) > 20);
  await page.focus('#stage');
  await page.keyboard.press('Escape');
  assert.ok(await page.isHidden('#ruler'));
  assert.equal(await page.getAttribute('[data-do=measure]', 'aria-pressed'), 'false');
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('a turn measures nothing, nor does a click beside the object; Enter takes the middle', { skip }, async () => {
  const page = await here.opened(level('metric.slf'));
  await page.keyboard.press('x');
  await page.mouse.move(240, 240);
  await page.mouse.down();
  await page.mouse.move(300, 240, { steps: 5 });
  await page.mouse.up();
  await page.mouse.click(20, 20);
  const ends = () => page.evaluate(() => window.viewer.ruler.ends.length);
  assert.equal(await ends(), 0);
  assert.equal(await page.textContent('#hint'), 'There is nothing here.');
  await page.focus('#stage');
  await page.keyboard.press('Enter');
  assert.equal(await ends(), 1);
  await click(page, 0, 30);
  assert.equal(await ends(), 2);
  await click(page, 0, 10);
  assert.equal(await ends(), 1, 'the third click begins anew');
  await page.close();
});

test('the bar of scale is as long as it says at the middle of the view, and not there where nobody knows', { skip }, async () => {
  const page = await here.opened(level('metric.slf'));
  await page.waitForSelector('#scale span');
  const [text, width] = [await page.textContent('#scale span'), await page.evaluate(() => parseFloat(document.querySelector('#scale i').style.width))];
  const pixel = await page.evaluate(() => {
    const { pose, canvas } = window.viewer.stage;
    return (window.viewer.metres * 2 * pose.distance * Math.tan((pose.fov * Math.PI) / 360)) / Math.min(canvas.clientWidth, canvas.clientHeight);
  });
  const [, number, unit] = /^([125]0*) (mm|cm|m)$/.exec(text);
  const said = Number(number) * { mm: 1e-3, cm: 1e-2, m: 1 }[unit];
  assert.ok(Math.abs(width * pixel - said) < 1e-4 * said, `${text}, ${width} pixels`); // styles keep six digits
  assert.ok(width > 55 && width <= 150.001, `${width}`);
  await page.close();
  for (const [query, shown] of [[level('metric.slf', '&scale=0'), false], [level('can.slf'), false], [level('can.slf', '&metres=0.1'), true]]) {
    const other = await here.opened(query);
    await other.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    assert.equal(await other.isVisible('#scale'), shown, query);
    await other.close();
  }
});

test('where nobody knows metres a length is in units, in the language of the page', { skip }, async () => {
  const page = await here.opened(level('can.slf', '&lang=de'));
  await page.keyboard.press('x');
  await click(page, 0, -40);
  await click(page, 0, 40);
  assert.match(await length(page), /^\d+(,\d+)? Einheiten$/);
  await page.close();
});

test('notes of the metadata show; those beside the file come first; bad ones are said', { skip }, async () => {
  const titles = (page) => page.evaluate(() => window.viewer.guide.notes.annotations.map((each) => each.title));
  const shown = (page) => page.waitForFunction(() => document.querySelectorAll('.mark-of-note').length > 0);
  const page = await here.opened(level('metric.slf'));
  await shown(page);
  assert.deepEqual(await titles(page), ['Middle']);
  await page.close();
  writeFileSync(join(here.can.dir, 'beside.json'), JSON.stringify({ version: 1, annotations: [{ at: [0, 0, 0], title: 'Beside' }] }));
  const other = await here.opened(level('metric.slf', '&notes=/files/beside.json'));
  await shown(other);
  assert.deepEqual(await titles(other), ['Beside']);
  await other.evaluate(() => window.viewer.guide.openOwn({ notes: '{"version": 2}' }));
  assert.deepEqual(await titles(other), []);
  assert.equal(await other.textContent('#status'), 'The notes cannot be read.');
  assert.deepEqual(other.wrong, []);
  await other.close();
});

test('a page of slf html has notes and metres that it was given', { skip }, async (t) => {
  const { dir } = here.can, out = join(dir, 'notes.html');
  try {
    slf('html', join(dir, 'can.slf'), '-o', out, '--notes', join(dir, 'own.json'), '--metres-per-unit', 2, '--no-poster', '--quiet');
  } catch (error) {
    if (error.status !== 6) throw error;
    return t.skip('skipped: slf was built before web/dist/one_file.html; npm run build, then build slf');
  }
  const page = await here.chrome.newPage();
  await page.goto(pathToFileURL(out).href);
  assert.equal(await settled(page), 'ready');
  await page.waitForSelector('.mark-of-note');
  assert.equal(await page.evaluate(() => window.viewer.metres), 2);
  await page.close();
});
