// SPDX-License-Identifier: Apache-2.0
// Light fields that move: played, held, scrubbed, stepped, repeated; damage; less motion; while they arrive.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { join } from 'node:path';
import { FRAMES, framesOf, framesUnderTest, GROUP, label, LEAST_DB, picture, player, RATE, shows, SIZE } from './frames_support.mjs';
import { psnr, rendered, skip, slf } from './support.mjs';

const here = framesUnderTest();

test('plays by itself, in order, over and over, and stands where it is held', { skip }, async () => {
  const page = await here.open('src=/files/tube.slf');
  await page.waitForFunction(() => window.told.filter(([name]) => name === 'framechange').length > 16);
  const seen = await framesOf(page);
  assert.ok(new Set(seen).size >= 6, seen.join());
  assert.ok(seen.some((place, i) => place < seen[i - 1]), 'it began again');
  assert.equal(await label(page), 'Pause');
  await page.click('[data-do=playback]');
  assert.equal(await label(page), 'Play');
  const held = await player(page);
  await page.waitForTimeout(500);
  const { shown, playing, frames, ended, duration } = await player(page);
  assert.deepEqual([shown, playing, frames, ended], [held.shown, false, FRAMES, true]);
  assert.ok(Math.abs(duration - FRAMES / RATE) < 1e-6);
  assert.deepEqual(await page.evaluate(() => window.told.map(([name]) => name).filter((name) => ['play', 'pause'].includes(name))), ['play', 'pause']);
  assert.match(await page.textContent('#subtitle'), /12 frames/);
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('frames that are scrubbed to are the pictures of slf render', { skip }, async (t) => {
  const page = await here.open('src=/files/tube.slf&paused=1', { viewport: { width: SIZE, height: SIZE } });
  for (const place of [9, 2, 11, 0]) {
    await page.evaluate((to) => {
      const scrub = document.getElementById('scrub');
      scrub.value = to;
      scrub.dispatchEvent(new Event('input', { bubbles: true }));
    }, place);
    await shows(page, place);
    assert.equal(await page.getAttribute('#scrub', 'aria-valuetext'), `Frame ${place + 1} of ${FRAMES}`);
    const value = psnr(await picture(page), rendered(here.file, { azimuth: 30, elevation: 20 }, SIZE, '--frame', place));
    t.diagnostic(`frame ${place}: ${value.toFixed(2)} dB`);
    assert.ok(value >= LEAST_DB, `frame ${place}: ${value}`);
  }
  await page.close();
});

test('textures are those of the frame before, where they hold the next', { skip }, async () => {
  const page = await here.open('src=/files/tube.slf&paused=1');
  const same = await page.evaluate(async () => {
    const { viewer } = window, { textures } = viewer.stage.pipeline, before = { ...textures };
    viewer.playback.seek(7);
    while (viewer.playback.player.shown !== 7) await new Promise((done) => setTimeout(done, 20));
    return Object.keys(before).filter((name) => viewer.stage.pipeline.textures[name] !== before[name]);
  });
  assert.deepEqual(same, []);
  await page.close();
});

test('keys: space plays and holds, comma and period step, arrows move the slider', { skip }, async () => {
  const page = await here.open('src=/files/tube.slf&paused=1');
  assert.equal((await player(page)).playing, false);
  await page.focus('#stage');
  await page.keyboard.press('.');
  await shows(page, 1);
  await page.keyboard.press('.');
  await shows(page, 2);
  await page.keyboard.press(',');
  await shows(page, 1);
  await page.keyboard.press('Space');
  await page.waitForFunction(() => window.viewer.playback.player.playing);
  await page.keyboard.press('Space');
  await page.waitForFunction(() => !window.viewer.playback.player.playing);
  await page.evaluate(() => window.viewer.playback.seek(5));
  await shows(page, 5);
  await page.focus('#scrub');
  await page.keyboard.press('ArrowRight');
  await shows(page, 6);
  await page.keyboard.press('End');
  await shows(page, FRAMES - 1);
  await page.keyboard.press('Space');
  await page.waitForFunction(() => window.viewer.playback.player.playing);
  await page.keyboard.press(',');
  assert.equal((await player(page)).playing, false);
  assert.equal(await page.evaluate(() => window.viewer.spinning ?? 0), 0); // space turned nothing
  await page.close();
});

test('with less motion it stands until somebody plays it', { skip }, async () => {
  const page = await here.open('src=/files/tube.slf', { reducedMotion: 'reduce' });
  await page.waitForTimeout(600);
  assert.deepEqual([(await player(page)).playing, await framesOf(page)], [false, []]);
  await page.click('[data-do=playback]');
  await page.waitForFunction(() => window.told.some(([name]) => name === 'framechange'));
  await page.close();
});

test('without a loop it ends at the last frame, and begins again', { skip }, async () => {
  const page = await here.open('src=/files/tube.slf&loop=0&speed=2');
  await page.waitForFunction(() => window.told.some(([name]) => name === 'ended'));
  assert.equal((await player(page)).playing, false);
  assert.equal(await page.getAttribute('[data-do=loop]', 'aria-pressed'), 'false');
  await page.click('[data-do=playback]');
  await page.waitForFunction(() => window.told.filter(([name]) => name === 'play').length === 2);
  await page.click('[data-do=loop]');
  assert.equal(await page.evaluate(() => window.viewer.playback.player.loop), true);
  await page.close();
});

test('a damaged frame is said, and playing goes on at the next group', { skip }, async () => {
  const page = await here.open('src=/files/damaged.slf');
  await page.waitForFunction(() => window.told.some(([name]) => name === 'frameerror'));
  await page.waitForFunction((group) => window.told.some(([name, frame]) => name === 'framechange' && frame >= 2 * group), GROUP);
  const said = await page.evaluate(() => window.told.find(([name]) => name === 'frameerror')[1]);
  assert.ok(said > GROUP && said < 2 * GROUP, `${said}`); // the damaged one, or one that is predicted from it
  const seen = await framesOf(page);
  assert.ok(seen.every((place) => place <= GROUP || place >= 2 * GROUP), seen.join());
  await page.evaluate((place) => window.viewer.playback.step(place - window.viewer.playback.player.frame), GROUP + 2);
  await page.waitForFunction(() => document.getElementById('frame-problem').textContent !== '');
  assert.equal(await page.textContent('#frame-problem'), `Frame ${GROUP + 2} is damaged.`);
  assert.equal(await page.isHidden('#problem'), true);
  await page.evaluate((place) => window.viewer.playback.seek(place), GROUP);
  await shows(page, GROUP);
  assert.equal(await page.textContent('#frame-problem'), '');
  await page.close();
});

test('it plays while it streams', { skip }, async () => {
  const page = await here.open('src=/files/slow.slf');
  const early = await player(page);
  assert.ok(!early.ended && early.frames < FRAMES, `${early.frames}`);
  await page.waitForFunction(() => window.viewer.playback.source.ended);
  assert.ok(new Set(await framesOf(page)).size >= 2);
  assert.match(await page.textContent('#subtitle'), /12 frames/);
  await page.close();
});

test('what plays goes on where levels are changed twice in a row', { skip }, async () => {
  const page = await here.open('src=/files/tube.slf');
  await page.waitForFunction(() => window.viewer.playback.player?.playing);
  await page.evaluate(() => Promise.all([window.viewer.decodeAgain({ levels: 5 }), window.viewer.decodeAgain({ levels: 4 })]));
  await page.waitForFunction(() => window.viewer.playback.player?.playing);
  assert.equal(await page.evaluate(() => window.viewer.stage.field.levels), 4);
  await page.close();
});

test('fewer levels hold for every frame, from where it stands', { skip }, async () => {
  const page = await here.open('src=/files/tube.slf&paused=1');
  await page.evaluate(() => window.viewer.playback.seek(6));
  await shows(page, 6);
  const points = () => page.evaluate(() => window.viewer.stage.field.points);
  const all = await points();
  await page.evaluate(() => window.viewer.decodeAgain({ levels: 4 }));
  assert.equal((await player(page)).shown, 6);
  assert.ok((await points()) < all / 2);
  await page.evaluate(() => window.viewer.playback.seek(9));
  await shows(page, 9);
  assert.ok((await points()) < all / 2);
  await page.close();
});

test('another file in its place does not move', { skip }, async () => {
  const page = await here.open('src=/files/tube.slf');
  slf('synth', 'can', '-o', join(here.dir, 'capture'), '--size', '48x48', '--quiet');
  slf('encode', join(here.dir, 'capture'), '-o', join(here.dir, 'can.slf'), '--effort', 1, '--quiet');
  await page.evaluate(() => window.viewer.open('/files/can.slf'));
  assert.deepEqual(await page.evaluate(() => [window.viewer.playback.moves, document.getElementById('player').hidden]), [false, true]);
  await page.focus('#stage');
  await page.keyboard.press('Space');
  await page.waitForFunction(() => window.viewer.spinning > 0); // turns, as ever
  assert.deepEqual(page.wrong, []);
  await page.close();
});
