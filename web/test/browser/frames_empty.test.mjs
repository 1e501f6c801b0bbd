// SPDX-License-Identifier: Apache-2.0
// Frames without points in the viewer: the background alone, at the beginning and between others.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { readdirSync } from 'node:fs';
import { join } from 'node:path';
import { empty, listen, picture, shows, SIZE } from './frames_support.mjs';
import { folder, launch, newPage, serve, settled, skip, slf } from './support.mjs';

const FRAMES = 4, EMPTY = [0, 2];
let dir, file, server, chrome;

before(async () => {
  if (skip) return;
  dir = folder();
  file = join(dir, 'tube.slf');
  slf('synth', 'tube2', '--frames', FRAMES, '--bits', 6, '-o', join(dir, 'tube'), '--quiet');
  const clouds = readdirSync(join(dir, 'tube')).filter((name) => name.endsWith('.ply')).sort();
  for (const place of EMPTY) empty(join(dir, 'tube', clouds[place]));
  slf('encode', join(dir, 'tube'), '-o', file, '--rate', 10, '--quiet');
  server = await serve({ files: dir });
  chrome = await launch();
});
after(async () => {
  await chrome?.close();
  server?.close();
});

test('an empty frame is the background, the others show something', { skip }, async (t) => {
  const page = await newPage(chrome, { viewport: { width: SIZE, height: SIZE } });
  await page.goto(`${server.page}?background=808080&src=/files/tube.slf&paused=1`);
  await listen(page);
  assert.equal(await settled(page), 'ready');
  const reds = async () => new Set((await picture(page)).data.filter((v, i) => i % 3 === 0));
  for (const place of [1, 2, 3, 0]) {
    await page.evaluate((to) => window.viewer.playback.seek(to), place);
    await shows(page, place);
    const seen = await reds();
    t.diagnostic(`frame ${place}: ${seen.size} values of red`);
    if (EMPTY.includes(place)) assert.deepEqual([...seen], [128]);
    else assert.ok(seen.size > 20, `frame ${place}`);
  }
  assert.deepEqual(page.wrong, []);
  await page.close();
});
