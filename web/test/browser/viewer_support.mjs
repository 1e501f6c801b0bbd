// SPDX-License-Identifier: Apache-2.0
// What tests of the viewer's page share: a can, files that are slow or broken, a server, Chromium.
import assert from 'node:assert/strict';
import { after, before } from 'node:test';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { launch, makeCan, newPage, serve, settled, skip } from './support.mjs';

/** can, server and chrome are there while the tests of the calling file run. */
export function viewerUnderTest() {
  const here = {
    async open(query, options) {
      const page = await newPage(here.chrome, options);
      await page.goto(`${here.server.page}?${query}`);
      return page;
    },
    async opened(query = 'src=/files/can.slf', options = undefined) {
      const page = await here.open(query, options);
      assert.equal(await settled(page), 'ready');
      return page;
    },
  };
  before(async () => {
    if (skip) return;
    here.can = makeCan(200);
    here.server = await serveWithFaults(here.can);
    here.chrome = await launch();
  });
  after(async () => {
    await here.chrome?.close();
    here.server?.close();
  });
  return here;
}

/** Moves a slider as a hand does. */
export const slide = (page, id, value) =>
  page.evaluate(
    ([name, to]) => {
      const input = document.getElementById(name);
      input.value = to;
      for (const type of ['input', 'change']) input.dispatchEvent(new Event(type, { bubbles: true }));
    },
    [id, value],
  );

/** The can, whole; one byte of it changed; cut; slow; over a connection that breaks, or falls silent. */
function serveWithFaults({ dir, bytes }) {
  const write = (name, content) => writeFileSync(join(dir, name), content);
  write(
    'damaged.slf',
    bytes.map((b, i) => (i === bytes.length >> 1 ? b ^ 0x55 : b)),
  );
  write('cut.slf', bytes.subarray(0, bytes.length >> 1));
  write('slow.slf', bytes);
  for (const name of ['breaks', 'stalls', 'silent']) write(`${name}.slf`, bytes);
  return serve(
    { files: dir },
    {
      'slow.slf': { chunk: 512, wait: 250 },
      'breaks.slf': { chunk: 2048, wait: 10, until: bytes.length / 2 },
      'stalls.slf': { chunk: 2048, wait: 10, until: bytes.length / 2, silent: true },
      'silent.slf': { chunk: 2048, wait: 10, until: 0, silent: true },
    },
  );
}
