// SPDX-License-Identifier: Apache-2.0
// Pages with <slf-viewer> in them.
import { existsSync, mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { newPage, skip as lacking, web } from './support.mjs';

export const skip = lacking || (!existsSync(join(web, 'made/viewer_markup.js')) && 'skipped: there is no made/ (web/build.sh)');

/** @param here  viewerUnderTest()  @returns pageOf(name, body, options): a page of its own with these viewers in it */
export const elementPages = (here) => async (name, body, options) => {
  mkdirSync(join(here.can.dir, 'pages'), { recursive: true });
  writeFileSync(
    join(here.can.dir, `pages/${name}.html`),
    `<!doctype html><html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>Cans</title>
<style>slf-viewer { height: 300px; margin: 10px }</style><main><h1>Cans</h1>${body}</main>
<script type="module" src="/some/path/web/viewer/slf_viewer.js"></script>`,
  );
  const page = await newPage(here.chrome, options);
  page.address = `${here.server.url}/files/pages/${name}.html`;
  await page.goto(page.address);
  return page;
};

export const state = (page, id, wanted = /^(ready|failed)/) =>
  page
    .waitForFunction(([name, source]) => new RegExp(source).test(document.getElementById(name).state), [id, wanted.source])
    .then(() => page.evaluate((name) => document.getElementById(name).state, id));
export const viewOf = (page, id = 'a') => page.evaluate((name) => document.getElementById(name).view, id);
export const viewer = (id, more = '') => `<slf-viewer id="${id}" src="/files/can.slf" ${more}></slf-viewer>`;
export const FAR = '<div style="height: 4000px"></div>';
