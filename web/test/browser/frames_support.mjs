// SPDX-License-Identifier: Apache-2.0
// What tests of light fields that move share: a tube that twists, a damaged one, a slow one, a server, Chromium.
import assert from 'node:assert/strict';
import { after, before } from 'node:test';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { folder, launch, newPage, readPng, serve, settled, skip, slf } from './support.mjs';

export const FRAMES = 12, GROUP = 4, RATE = 10, SIZE = 240;
export const LEAST_DB = 45; // of a page's picture against slf render

/** dir, file, server and chrome are there while the tests of the calling file run. */
export function framesUnderTest() {
  const here = {
    async open(query, options) {
      const page = await newPage(here.chrome, options);
      await page.goto(`${here.server.page}?background=808080&${query}`);
      await listen(page);
      assert.equal(await settled(page), 'ready');
      return page;
    },
  };
  before(async () => {
    if (skip) return;
    here.dir = folder();
    here.file = join(here.dir, 'tube.slf');
    slf('synth', 'tube2', '--frames', FRAMES, '--bits', 6, '-o', join(here.dir, 'tube'), '--quiet');
    slf('encode', join(here.dir, 'tube'), '-o', here.file, '--group', GROUP, '--rate', RATE, '--quiet');
    const bytes = readFileSync(here.file),
      { frames } = JSON.parse(slf('info', here.file, '--json').toString()),
      at = frames[GROUP + 1].offset + 60; // of the second frame of the second group
    writeFileSync(join(here.dir, 'damaged.slf'), bytes.map((b, i) => (i === at ? b ^ 4 : b)));
    writeFileSync(join(here.dir, 'slow.slf'), bytes);
    here.server = await serve({ files: here.dir }, { 'slow.slf': { chunk: Math.ceil(bytes.length / 12), wait: 400 } });
    here.chrome = await launch();
  });
  after(async () => {
    await here.chrome?.close();
    here.server?.close();
  });
  return here;
}

/** Keeps what the viewer tells, from its beginning. */
export const listen = (page) =>
  page.evaluate(async () => {
    while (!window.viewer) await new Promise((done) => setTimeout(done, 5));
    const { viewer } = window, emit = viewer.emit;
    window.told = [];
    viewer.emit = (name, detail) => {
      window.told.push([name, detail?.frame]);
      emit(name, detail);
    };
  });

export const player = (page) =>
  page.evaluate(() => {
    const { player: p, source } = window.viewer.playback;
    return { playing: p.playing, frame: p.frame, shown: p.shown, time: p.time, duration: p.duration, frames: source.list.length, ended: source.ended };
  });
export const shows = (page, place) => page.waitForFunction((wanted) => window.viewer.playback.player.shown === wanted, place);
export const framesOf = (page) => page.evaluate(() => window.told.filter(([name]) => name === 'framechange').map(([, place]) => place));
export const label = (page) => page.evaluate(() => document.querySelector('[data-do=playback]').getAttribute('aria-label'));

export async function picture(page) {
  const base64 = await page.evaluate(async () => {
    window.viewer.fit();
    const blob = await window.viewer.stage.screenshot();
    return btoa(Array.from(new Uint8Array(await blob.arrayBuffer()), (b) => String.fromCharCode(b)).join(''));
  });
  return readPng(Buffer.from(base64, 'base64'));
}

/** Leaves a PLY without a vertex. */
export function empty(ply) {
  const text = readFileSync(ply, 'latin1'), end = 'end_header\n';
  writeFileSync(ply, text.slice(0, text.indexOf(end) + end.length).replace(/element vertex \d+/, 'element vertex 0'), 'latin1');
}
