// SPDX-License-Identifier: Apache-2.0
// A light field that moves as an object of three.js, drawn: its frames are those of slf render, there and back; it plays
// by the page's clock, while it arrives, among clones; and what dispose() leaves.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { FRAMES, framesUnderTest, GROUP, LEAST_DB, RATE, SIZE } from './frames_support.mjs';
import { newPage, psnr, rendered, skip, threePictureOf } from './support.mjs';

const here = framesUnderTest(), VIEW = { azimuth: 30, elevation: 20 };

/** three.html with a file; it stands still where `still`. */
async function scenePage(file = 'tube.slf', still = true) {
  const page = await newPage(here.chrome, { viewport: { width: SIZE, height: SIZE }, reducedMotion: still ? 'reduce' : 'no-preference' });
  await page.goto(`${here.server.three}?src=/files/${file}`);
  await page.waitForFunction(() => window.ready || window.failed);
  assert.equal(await page.evaluate(() => window.failed?.message), undefined);
  await page.evaluate(() => {
    window.told = [];
    for (const type of ['framechange', 'frameerror', 'ended', 'error'])
      window.field.addEventListener(type, ({ frame }) => window.told.push([type, frame]));
  });
  return page;
}

test('frames by time, there and back, are the pictures of slf render', { skip }, async (t) => {
  const page = await scenePage(), pictures = new Map();
  for (const place of [0, 9, 2, 9]) {
    assert.equal(await page.evaluate((seconds) => window.field.setTime(seconds), place / RATE), place);
    const picture = await threePictureOf(page, VIEW, SIZE), value = psnr(picture, rendered(here.file, VIEW, SIZE, '--frame', place));
    t.diagnostic(`frame ${place}: ${value.toFixed(2)} dB`);
    assert.ok(value >= LEAST_DB, `frame ${place}: ${value}`);
    if (pictures.has(place)) assert.deepEqual(picture.data, pictures.get(place).data, 'the frame that was there before');
    pictures.set(place, picture);
  }
  const apart = psnr(pictures.get(9), pictures.get(2));
  t.diagnostic(`frame 9 against frame 2: ${apart.toFixed(2)} dB`);
  assert.ok(apart < LEAST_DB - 10, `${apart}`);
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('it plays by the clock of the page, over and over, and every frame that shows is drawn', { skip }, async () => {
  const page = await scenePage('tube.slf', false);
  await page.evaluate(() => {
    const gl = window.renderer.getContext();
    window.seen = new Set();
    window.field.addEventListener('framechange', () => { // after the page's own, which draws
      const pixels = new Uint8Array(4 * 64 * 64);
      gl.readPixels(88, 88, 64, 64, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      window.seen.add(String(pixels.filter((_, i) => i % 4 === 0)));
    });
  });
  await page.waitForFunction(() => window.told.filter(([type]) => type === 'framechange').length > 14);
  const { places, seen, paused, duration, frames } = await page.evaluate(() => ({
    places: window.told.map(([, place]) => place), seen: window.seen.size,
    paused: window.field.paused, duration: window.field.duration, frames: window.field.frames,
  }));
  assert.ok(new Set(places).size >= 6 && places.some((place, i) => place < places[i - 1]), `${places}`);
  assert.ok(seen >= new Set(places).size - 1, `${seen} pictures of ${places}`);
  assert.deepEqual([paused, frames], [false, FRAMES]);
  assert.ok(Math.abs(duration - FRAMES / RATE) < 1e-6);
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('with less motion the example stands until somebody plays it', { skip }, async () => {
  const page = await scenePage();
  await page.waitForTimeout(500);
  assert.deepEqual(await page.evaluate(() => [window.field.paused, window.field.frame, window.told]), [true, 0, []]);
  await page.evaluate(() => window.field.play());
  await page.waitForFunction(() => window.told.length > 2);
  await page.close();
});

test('a frame goes into the textures of the frame before, of a clone too', { skip }, async () => {
  const page = await scenePage();
  const said = await page.evaluate(async () => {
    const { scene, camera, renderer, field } = window, { createTexture } = WebGL2RenderingContext.prototype;
    const draw = () => renderer.render(scene, camera);
    const pixels = () => {
      draw();
      const gl = renderer.getContext(), data = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
      gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, data);
      return data;
    };
    draw();
    let made = 0;
    WebGL2RenderingContext.prototype.createTexture = function () {
      ++made;
      return createTexture.call(this);
    };
    await field.setFrame(7);
    const original = pixels(), clone = field.clone();
    scene.remove(field);
    scene.add(clone);
    const cloned = pixels();
    await clone.setFrame(8);
    const next = pixels(), apart = (a, b) => a.reduce((sum, v, i) => sum + (v !== b[i]), 0);
    return { made, clones: apart(original, cloned), frames: apart(original, next) };
  });
  assert.deepEqual([said.made, said.clones], [0, 0]);
  assert.ok(said.frames > 100, `${said.frames}`);
  await page.close();
});

test('dispose() while frames are decoded ends the worker, with the last of the clones', { skip }, async () => {
  const page = await scenePage('tube.slf', false), workers = () => page.workers().length;
  assert.equal(workers(), 1);
  const said = await page.evaluate(async () => {
    const { field } = window, clone = field.clone();
    field.dispose();
    const shown = await clone.setFrame(5), late = clone.setFrame(11).catch((error) => error.name);
    clone.play();
    clone.dispose();
    return { shown, late: await late, again: await clone.setFrame(3).catch((error) => error.name), plays: [clone.update(1), clone.paused] };
  });
  assert.deepEqual(said, { shown: 5, late: 'AbortError', again: 'AbortError', plays: [false, true] });
  for (let i = 0; i < 100 && workers() > 0; ++i) await page.waitForTimeout(20);
  assert.equal(workers(), 0);
  const told = await page.evaluate(() => window.told.length);
  await page.waitForTimeout(300);
  assert.equal(await page.evaluate(() => window.told.length), told);
  await page.evaluate(() => window.renderer.render(window.scene, window.camera)); // it stands where it stood
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('stream() gives the first frame while the others arrive', { skip }, async () => {
  const page = await scenePage();
  const { early, all, place } = await page.evaluate(async (frames) => {
    const { SLFLoader } = await import(new URL('SLFLoader.js', document.baseURI));
    const field = await new SLFLoader().stream('/files/slow.slf', () => {}), early = field.frames;
    while (field.frames < frames) await new Promise((done) => setTimeout(done, 50));
    const place = await field.setFrame(frames - 1);
    field.dispose();
    return { early, all: field.frames, place };
  }, FRAMES);
  assert.ok(early >= 1 && early < FRAMES, `${early}`);
  assert.deepEqual([all, place], [FRAMES, FRAMES - 1]);
  await page.close();
});

test('a damaged frame is told, and playing goes on at the next group', { skip }, async () => {
  const page = await scenePage('damaged.slf', false);
  await page.waitForFunction((place) => window.told.some(([type, frame]) => type === 'framechange' && frame >= place), 2 * GROUP);
  await page.waitForFunction(() => window.told.some(([type]) => type === 'frameerror'));
  const shown = (await page.evaluate(() => window.told)).filter(([type]) => type === 'framechange').map(([, place]) => place);
  assert.ok(shown.every((place) => place <= GROUP || place >= 2 * GROUP), `${shown}`);
  assert.equal(await page.evaluate((place) => window.field.setFrame(place).catch((error) => error.kind), GROUP + 2), 'damaged');
  await page.close();
});

test('parse() plays on the thread of the page, with the levels that were asked for', { skip }, async () => {
  const page = await scenePage();
  const said = await page.evaluate(async () => {
    const { SLFLoader } = await import(new URL('SLFLoader.js', document.baseURI));
    const bytes = await (await fetch('/files/tube.slf')).arrayBuffer(), all = await new SLFLoader().parse(bytes);
    const field = await new SLFLoader().setPart({ levels: 4 }).parse(bytes), fewer = [];
    for (const place of [7, 3]) {
      await Promise.all([all.setFrame(place), field.setFrame(place), window.field.setFrame(place)]);
      fewer.push(field.packed.points < all.packed.points / 2, all.packed.points === window.field.packed.points);
    }
    const late = field.setFrame(11).catch((error) => error.name);
    field.dispose();
    return { fewer, late: await late, frames: all.frames };
  });
  assert.deepEqual(said, { fewer: [true, true, true, true], late: 'AbortError', frames: FRAMES });
  assert.deepEqual(page.wrong, []);
  await page.close();
});
