// SPDX-License-Identifier: Apache-2.0
// Gaussian splats that move, in the viewer's page and the one-file page: each frame is the picture of slf render.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { empty, listen, picture, player, shows, SIZE } from './frames_support.mjs';
import { folder, launch, newPage, psnr, rendered, serve, settled, skip, slf } from './support.mjs';

const FRAMES = 5, GROUP = 3, EMPTY = 3, LEAST = 35; // dB, as of splats that stand still
let dir, file, server, chrome;

before(async () => {
  if (skip) return;
  dir = folder();
  file = join(dir, 'splats.slf');
  slf('synth', 'tube2', '--frames', FRAMES, '--bits', 6, '-o', join(dir, 'tube'), '--quiet');
  slf('encode', join(dir, 'tube'), '-o', join(dir, 'tube.slf'), '--quiet');
  slf('export', join(dir, 'tube.slf'), '--frames', `0:${FRAMES - 1}`, '-o', join(dir, 's_%d.ply'), '--degree', 0, '--quiet');
  empty(join(dir, `s_${EMPTY}.ply`));
  slf('encode', join(dir, 's_%d.ply'), '-o', file, '--group', GROUP, '--rate', 10, '--quiet');
  server = await serve({ files: dir });
  chrome = await launch();
});
after(async () => {
  await chrome?.close();
  server?.close();
});

test('frames of splats are the pictures of slf render, in any order', { skip }, async (t) => {
  const page = await newPage(chrome, { viewport: { width: SIZE, height: SIZE } });
  await page.goto(`${server.page}?background=808080&src=/files/splats.slf&paused=1`);
  await listen(page);
  assert.equal(await settled(page), 'ready');
  for (const place of [4, 1, 2, 0]) {
    await page.evaluate((to) => window.viewer.playback.seek(to), place);
    await shows(page, place);
    const value = psnr(await picture(page), rendered(file, { azimuth: 30, elevation: 20 }, SIZE, '--frame', place));
    t.diagnostic(`frame ${place}: ${value.toFixed(2)} dB`);
    assert.ok(value >= LEAST, `frame ${place}: ${value}`);
  }
  await page.evaluate((to) => window.viewer.playback.seek(to), EMPTY);
  await shows(page, EMPTY);
  assert.deepEqual([...new Set((await picture(page)).data)], [128]);
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('one page plays them from a file', { skip }, async () => {
  const html = join(dir, 'splats.html');
  slf('html', file, '-o', html, '--quiet');
  const page = await newPage(chrome);
  await page.goto(pathToFileURL(html).href);
  await listen(page);
  await page.waitForFunction(() => new Set(window.told.filter(([name]) => name === 'framechange').map(([, at]) => at)).size === 5);
  assert.equal((await player(page)).frames, FRAMES);
  assert.deepEqual(page.wrong, []);
  await page.close();
});
