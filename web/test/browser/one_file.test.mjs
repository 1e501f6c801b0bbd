// SPDX-License-Identifier: Apache-2.0
// The page that `slf html` makes, opened from a disk.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { statSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { launch, makeCan, newPage, psnr, readPng, settled, skip, slf } from './support.mjs';

const MOST_BESIDE_FILE = 230_000; // bytes: code, decoder, five languages, style, a poster

let can, page, chrome, file, without;

before(async () => {
  if (skip) return;
  can = makeCan(320);
  file = join(can.dir, 'page.html');
  try {
    slf(
      'html',
      can.file,
      '-o',
      file,
      '--title',
      'A <can>',
      '--azimuth',
      can.views[1].azimuth,
      '--elevation',
      can.views[1].elevation,
      '--background',
      '808080',
      '--quiet',
    );
  } catch (error) {
    if (error.status !== 6) throw error;
    without = 'skipped: slf was built before web/dist/one_file.html; npm run build, then build slf';
    return;
  }
  chrome = await launch();
  page = await newPage(chrome, { viewport: { width: can.size, height: can.size } });
  await page.goto(pathToFileURL(file).href, { waitUntil: 'domcontentloaded' });
});
after(() => chrome?.close());

test('a poster stands there first, then the light field with the picture of slf render', { skip }, async (t) => {
  if (without) return t.skip(without);
  assert.ok(await page.evaluate(() => document.getElementById('poster').naturalWidth === 480));
  assert.equal(await settled(page), 'ready');
  assert.equal(await page.title(), 'A <can>: surface light field');
  await page.waitForFunction(() => document.getElementById('poster').hidden);
  const base64 = await page.evaluate(async () => {
    const blob = await window.viewer.stage.screenshot();
    return btoa(Array.from(new Uint8Array(await blob.arrayBuffer()), (b) => String.fromCharCode(b)).join(''));
  });
  const value = psnr(readPng(Buffer.from(base64, 'base64')), can.pictures[1]);
  t.diagnostic(`${value.toFixed(2)} dB`);
  assert.ok(value >= 35);
  assert.deepEqual(page.wrong, []);
});

test('nobody is asked for anything', { skip }, async (t) => {
  if (without) return t.skip(without);
  assert.deepEqual(
    page.asked.filter((url) => !/^(blob|data):/.test(url) && url !== pathToFileURL(file).href),
    [],
  );
  assert.equal(
    await page.evaluate(() =>
      fetch('http://127.0.0.1:9/').then(
        () => 'asked',
        (error) => error.name,
      ),
    ),
    'TypeError',
  );
});

test('the page is little more than its file', { skip }, (t) => {
  if (without) return t.skip(without);
  const beside = statSync(file).size - Math.ceil(can.bytes.length / 3) * 4;
  t.diagnostic(`${beside} bytes beside the file of ${can.bytes.length}`);
  assert.ok(beside <= MOST_BESIDE_FILE, `${beside} bytes`);
});
