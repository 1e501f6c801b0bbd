// SPDX-License-Identifier: Apache-2.0
// When a file shows over a slow network: the first picture, and the whole.
//   node web/test/browser/slow_load.mjs FILE.slf [kbit/s, default 750: 3G]
// The viewer's page in Chromium, from a server that sends the file at that rate; seconds since the
// page asked for it. The page itself and the decoder come at once, as from a cache.
import { readFileSync } from 'node:fs';
import { basename, dirname, resolve } from 'node:path';
import { launch, newPage, serve, settled, skip } from './support.mjs';

const [file, rate = '750'] = process.argv.slice(2);
if (skip || !file) {
  console.log(skip || 'a file is needed');
  process.exit(77);
}
const CHUNK = 4096,
  wait = (CHUNK * 8) / Number(rate); // ms
const name = basename(file),
  server = await serve({ files: dirname(resolve(file)) }, { [name]: { chunk: CHUNK, wait } });
const chrome = await launch();
const page = await newPage(chrome);
page.on('console', (message) => console.log(message.text()));
await page.goto(`${server.page}`);
await page.evaluate((url) => {
  const { viewer } = window,
    { arriving } = viewer,
    show = viewer.show.bind(viewer);
  const begin = performance.now(),
    since = () => ((performance.now() - begin) / 1000).toFixed(1);
  let bytes = 0;
  viewer.arriving = (received, total) => {
    bytes = received;
    if (received > 0 && received === total) console.log(`arrived ${since()} s`);
    arriving.call(viewer, received, total);
  };
  viewer.show = (packed, info, final, start) => {
    show(packed, info, final, start);
    console.log(`${final ? 'whole' : 'coarse'} ${since()} s, ${packed.points} points; ${bytes} bytes had arrived`);
  };
  viewer.open(url, 'file');
}, `/files/${name}`);
const state = await settled(page);
console.log(`${name}: ${readFileSync(file).length} bytes at ${rate} kbit/s: ${state}`);
await chrome.close();
server.close();
