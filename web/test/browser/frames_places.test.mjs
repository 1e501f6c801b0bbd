// SPDX-License-Identifier: Apache-2.0
// Light fields that move, elsewhere than on the viewer's page: in <slf-viewer>, as splats, in one file.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { existsSync, mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { FRAMES, framesUnderTest, LEAST_DB, listen, picture, RATE, shows, SIZE } from './frames_support.mjs';
import { newPage, psnr, rendered, settled, skip, slf, web } from './support.mjs';

const here = framesUnderTest();
const axe = join(web, 'node_modules/axe-core/axe.min.js');

const unmade = !existsSync(join(web, 'made/viewer_markup.js')) && 'skipped: there is no made/ (web/build.sh)';

test('<slf-viewer>: play, pause, frame, duration, loop, speed and their events', { skip: skip || unmade }, async () => {
  mkdirSync(join(here.dir, 'pages'), { recursive: true });
  writeFileSync(join(here.dir, 'pages/one.html'), `<!doctype html><html lang="en"><meta charset="utf-8"><title>Tube</title>
<style>slf-viewer { height: 300px }</style><main><h1>Tube</h1><slf-viewer id="a" src="/files/tube.slf" paused loop="0"></slf-viewer></main>
<script type="module" src="/some/path/web/viewer/slf_viewer.js"></script>`);
  const page = await newPage(here.chrome);
  await page.goto(`${here.server.url}/files/pages/one.html`);
  await page.waitForFunction(() => document.getElementById('a').state === 'ready');
  const at = await page.evaluate(async () => {
    const a = document.getElementById('a'), told = (name) => new Promise((done) => a.addEventListener(name, done, { once: true }));
    const first = [a.paused, a.frame, a.loop, a.speed];
    while (a.frames < 12) await new Promise((done) => setTimeout(done, 20));
    const changed = told('framechange');
    a.frame = 3;
    const { detail } = await changed, playing = told('play');
    a.speed = 4;
    const ended = told('ended');
    a.play();
    await playing;
    const running = a.paused;
    await ended;
    const last = [a.paused, a.frame];
    a.loop = true;
    a.play();
    const pausing = told('pause');
    a.pause();
    await pausing;
    return { first, detail, running, last, loop: a.loop, speed: a.speed, duration: a.duration };
  });
  assert.deepEqual(at.first, [true, 0, false, 1]);
  assert.deepEqual([at.detail.frame, at.detail.number], [3, 3]);
  assert.deepEqual([at.running, at.last, at.loop, at.speed], [false, [true, FRAMES - 1], true, 4]);
  assert.ok(Math.abs(at.duration - FRAMES / RATE) < 1e-6);
  if (existsSync(axe)) {
    await page.addScriptTag({ path: axe });
    const found = await page.evaluate(async () => (await window.axe.run()).violations.map(({ id }) => id));
    assert.deepEqual(found, []);
  }
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('a file of splats does not stand in the way: any kind of points may move', { skip }, async () => {
  const page = await here.open('src=/files/tube.slf&paused=1');
  const uploaded = await page.evaluate(async () => {
    const { viewer } = window, { stage } = viewer, parts = (name) => import(new URL(name, document.baseURI));
    const { SplatPipeline } = await parts('splat_pipeline.js'), { writeSplat } = await parts('packed_texels.js');
    const splats = (points, radius) => {
      const rows = Math.ceil(points / 64), texels = 64 * rows, words = (n) => new Uint32Array(n * texels),
        [places, tails] = [words(4), words(2)];
      for (let p = 0; p < points; ++p) {
        const place = [1, 2, 3].map((k) => 512 + Math.round(Math.sin(p * k) * radius));
        writeSplat(places, tails, p, place, [0.5, 0, 0, 0.5, 0, 0.5], 0.5);
      }
      return { ...stage.packed, splats: true, moving: true, points, columns: 64, rows, nearest: 0.001, middle: [512, 512, 512],
        places, tails, directions: null, means: new Uint8Array(4 * texels).fill(200), weights: words(4 * stage.packed.weightLayers) };
    };
    const shows = (packed) => {
      stage.setField(packed);
      stage.draw();
      const { gl } = stage, pixel = new Uint8Array(4), box = stage.canvas;
      gl.readPixels(box.width >> 1, box.height >> 1, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      return [stage.pipeline instanceof SplatPipeline, gl.getError(), stage.pipeline.sorting.count];
    };
    const first = shows(splats(640, 3)), kept = stage.pipeline.textures.places, second = shows(splats(600, 4)),
      same = kept === stage.pipeline.textures.places, third = shows(splats(6400, 4));
    return { first, second, third, same, grown: kept !== stage.pipeline.textures.places };
  });
  assert.deepEqual(uploaded, { first: [true, 0, 640], second: [true, 0, 600], third: [true, 0, 6400], same: true, grown: true });
  await page.close();
});

test('one file: slf html of a light field that moves plays from a disk', { skip }, async (t) => {
  const out = join(here.dir, 'page.html');
  try {
    slf('html', here.file, '-o', out, '--background', '808080', '--speed', '2', '--quiet');
  } catch (error) {
    if (error.status !== 6) throw error;
    return t.skip('skipped: slf was built before web/dist/one_file.html; npm run build, then build slf');
  }
  const page = await newPage(here.chrome, { viewport: { width: SIZE, height: SIZE } });
  await page.goto(pathToFileURL(out).href, { waitUntil: 'domcontentloaded' });
  await listen(page);
  assert.equal(await settled(page), 'ready');
  await page.waitForFunction(() => window.told.filter(([name]) => name === 'framechange').length > 5);
  assert.equal(await page.evaluate(() => window.viewer.playback.player.speed), 2);
  await page.evaluate(() => (window.viewer.playback.pause(), window.viewer.playback.seek(7)));
  await shows(page, 7);
  assert.ok(psnr(await picture(page), rendered(here.file, { azimuth: 30, elevation: 20 }, SIZE, '--frame', 7)) >= LEAST_DB);
  assert.deepEqual(page.asked.filter((url) => !/^(blob|data|file):/.test(url)), []);
  assert.deepEqual(page.wrong, []);
  await page.close();
});
