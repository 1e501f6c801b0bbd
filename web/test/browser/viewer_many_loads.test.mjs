// SPDX-License-Identifier: Apache-2.0
// File after file in one page: every refused one of the suite, and the same ones again; nothing is left of them.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { newPage, repository, settled, skip } from './support.mjs';
import { viewerUnderTest } from './viewer_support.mjs';

const here = viewerUnderTest();

test(
  'every refused stream of the conformance suite gives an error, and a sound file still opens after',
  { skip },
  async (t) => {
    const root = join(repository, 'conformance/refused'),
      page = await here.opened();
    const names = readdirSync(root, { recursive: true }).filter((name) => name.endsWith('.slf'));
    assert.ok(names.length > 20);
    const open = (base64) =>
      page.evaluate(async (text) => {
        await window.viewer.open(
          Uint8Array.from(atob(text), (c) => c.charCodeAt(0)),
          'refused',
        );
        return document.body.dataset.state;
      }, base64);
    const shown = [];
    for (const name of names) {
      const state = await open(readFileSync(join(root, name)).toString('base64'));
      if (!/^failed (damaged|unsupported|too-large|no-view-maps)$/.test(state)) shown.push(`${name}: ${state}`);
    }
    t.diagnostic(`${names.length} streams`);
    assert.deepEqual(shown, []);
    assert.equal(await open(here.can.bytes.toString('base64')), 'ready');
    assert.deepEqual(page.wrong, []);
    await page.close();
  },
);

for (const [name, end] of [['can', 'ready'], ['damaged', 'failed damaged']])
  test(`twenty loads of ${name}.slf leave no worker, as many textures and no more memory than a few`, { skip }, async (t) => {
    const page = await newPage(here.chrome);
    await page.addInitScript(() => {
      window.textures = 0;
      const { createTexture, deleteTexture } = WebGL2RenderingContext.prototype;
      WebGL2RenderingContext.prototype.createTexture = function () {
        ++window.textures;
        return createTexture.call(this);
      };
      WebGL2RenderingContext.prototype.deleteTexture = function (x) {
        if (x) --window.textures;
        return deleteTexture.call(this, x);
      };
    });
    await page.goto(`${here.server.page}?src=/files/${name}.slf`);
    assert.equal(await settled(page), end);
    const session = await page.context().newCDPSession(page);
    const state = async () => {
      await session.send('HeapProfiler.collectGarbage');
      const { usedSize } = await session.send('Runtime.getHeapUsage');
      return { heap: usedSize, textures: await page.evaluate(() => window.textures), workers: page.workers().length };
    };
    const load = (n) =>
      page.evaluate(async ([file, times]) => {
        for (let i = 0; i < times; ++i) await window.viewer.open(file, 'again');
      }, [`/files/${name}.slf`, n]);
    await load(3);
    const early = await state();
    await load(17);
    const late = await state();
    t.diagnostic(`heap ${early.heap} -> ${late.heap}, textures ${late.textures}, workers ${late.workers}`);
    assert.equal(late.workers, 0);
    assert.equal(late.textures, early.textures);
    assert.ok(late.heap < early.heap + (1 << 20), `${early.heap} -> ${late.heap}`);
    await page.close();
  });
