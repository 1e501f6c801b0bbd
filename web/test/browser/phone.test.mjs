// SPDX-License-Identifier: Apache-2.0
// A phone whose memory does not hold all of a file: it has fewer functions, says so, and shows all when asked.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { before, test } from 'node:test';
import { newPage, settled, skip, slf } from './support.mjs';
import { viewerUnderTest } from './viewer_support.mjs';

const here = viewerUnderTest();
before(() => {
  if (skip) return;
  const { capture, dir } = here.can; // its default has two groups, and no phone has fewer
  slf('encode', capture, '-o', join(dir, 'groups.slf'), '--degree', 4, '--effort', 1, '--quiet');
});

const PHONE = {
  viewport: { width: 390, height: 844 },
  screen: { width: 390, height: 844 },
  isMobile: true,
  hasTouch: true,
};

/** What the can takes: bytes of all groups, and of all but one. */
async function costs() {
  const page = await here.opened('src=/files/groups.slf'),
    found = await page.evaluate(async () => {
      const { SlfDecoder } = await import(new URL('../slf.js', document.baseURI)),
        decoder = await SlfDecoder.create(),
        reader = decoder.frames();
      reader.push(new Uint8Array(await (await fetch('/files/groups.slf')).arrayBuffer()));
      reader.finish();
      const { groups } = reader.info(),
        cost = (some) => reader.preflight(0, { groups: some }).memoryBytes;
      return { groups, all: cost(0), fewer: cost(groups - 1) };
    });
  await page.close();
  return found;
}

/** A device with so much memory, from before the page's own code. */
async function deviceWith(bytes, options) {
  const page = await newPage(here.chrome, options);
  await page.addInitScript((gibibytes) => {
    Object.defineProperty(Navigator.prototype, 'deviceMemory', { get: () => gibibytes });
  }, bytes / 2 ** 30);
  return page;
}

const shown = (page) =>
  page.evaluate(() => ({
    facts: window.viewer.facts.coarser,
    components: window.viewer.stage.field.components,
    functions: window.viewer.facts.info.components,
    slider: Number(document.querySelector('#groups').value),
  }));

test('a phone has the functions that it holds, says so in its language, and shows all when asked', { skip }, async () => {
  const { groups, all, fewer } = await costs();
  assert.ok(groups > 2 && fewer < all, `${groups} groups: ${fewer} and ${all} bytes`);
  const page = await deviceWith(8 * (all - 1), PHONE); // an eighth of it is for a decode
  await page.goto(`${here.server.page}?src=/files/groups.slf&lang=fr`);
  assert.equal(await settled(page), 'ready');
  const little = await shown(page);
  assert.equal(little.facts.groups, groups - 1);
  assert.equal(little.slider, groups - 1);
  assert.ok(little.components < little.functions);
  assert.match(await page.textContent('#subtitle'), new RegExp(`faute de mémoire : ${groups - 1} groupes sur ${groups}`));
  const button = page.getByRole('button', { name: 'Tout afficher' });
  assert.ok((await button.boundingBox()).height >= 24);
  await button.tap();
  await page.waitForFunction(() => window.viewer.facts.coarser === undefined);
  const whole = await shown(page);
  assert.deepEqual([whole.components, whole.slider], [whole.functions, groups]);
  assert.ok(await button.isHidden());
  assert.doesNotMatch(await page.textContent('#subtitle'), /mémoire/);
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('an address says how much a phone may take, and a desk with as little memory has all', { skip }, async () => {
  const { all } = await costs();
  for (const [options, query] of [[PHONE, '&memory=2000'], [{}, '']]) {
    const page = await deviceWith(8 * (all - 1), options);
    await page.goto(`${here.server.page}?src=/files/groups.slf${query}`);
    assert.equal(await settled(page), 'ready');
    assert.equal((await shown(page)).facts, undefined, query);
    assert.ok(await page.isHidden('#caption [data-do=all]'));
    await page.close();
  }
});

test('what a phone holds no part of is refused, and shown when asked', { skip }, async () => {
  const page = await deviceWith(2 ** 17, PHONE);
  await page.goto(`${here.server.page}?src=/files/groups.slf`);
  assert.equal(await settled(page), 'failed too-large');
  await page.locator('#problem').getByRole('button', { name: 'Show all' }).tap();
  await page.waitForFunction(() => document.body.dataset.state === 'ready');
  assert.equal((await shown(page)).facts, undefined);
  assert.ok(await page.isHidden('#problem'));
  assert.deepEqual(page.wrong, []);
  await page.close();
});
