// SPDX-License-Identifier: Apache-2.0
// Memory of a page with a file, against the forecast of `slf info`: MiB of the renderer's process.
//   node web/test/browser/memory.mjs FILE.slf
import { readdirSync, readFileSync } from 'node:fs';
import { basename, dirname, resolve } from 'node:path';
import { launch, newPage, serve, settled, skip, slf } from './support.mjs';

const [file] = process.argv.slice(2), MIB = 2 ** 20;
if (skip || !file) {
  console.log(skip || 'a file is needed');
  process.exit(77);
}

/** Private memory of all renderers of this process's browser, MiB. */
function renderers() {
  const read = (path) => {
    try {
      return readFileSync(path, 'utf8');
    } catch {
      return ''; // it has ended
    }
  };
  const all = readdirSync('/proc').filter((name) => /^\d+$/.test(name));
  const parents = new Map(all.map((id) => [id, /^PPid:\s+(\d+)/m.exec(read(`/proc/${id}/status`))?.[1]]));
  const ours = (id) => id !== undefined && (id === String(process.pid) || ours(parents.get(id)));
  let sum = 0;
  for (const id of all)
    if (ours(id) && read(`/proc/${id}/cmdline`).includes('--type=renderer'))
      for (const [, kib] of read(`/proc/${id}/smaps_rollup`).matchAll(/^Private_\w+:\s+(\d+)/gm)) sum += Number(kib) / 1024;
  return Math.round(sum);
}

const info = JSON.parse(slf('info', file, '--json'));
const server = await serve({ files: dirname(resolve(file)) }), chrome = await launch();
const page = await newPage(chrome);
await page.goto(server.page);
await page.waitForTimeout(1000);
const empty = renderers();
let peak = empty;
const timer = setInterval(() => (peak = Math.max(peak, renderers())), 100);
await page.evaluate((url) => void window.viewer.open(url, 'file'), `/files/${basename(file)}`);
const state = await settled(page);
clearInterval(timer);
await page.waitForTimeout(2000);
await page.evaluate(() => gc());
await page.waitForTimeout(1000);
const { bytes, points, layers } = await page.evaluate(() => window.viewer.stage.field ?? {});
const forecast = info.decode.page.memory / MIB;
const mib = (number) => `${(number / MIB).toFixed(0)} MiB`;
console.log(`${basename(file)}: ${state}, ${points} points, ${layers} layers; forecast of slf info ${forecast.toFixed(0)} MiB, textures ${mib(bytes)}`);
console.log(`renderer: empty ${empty}, peak +${peak - empty}, at rest +${renderers() - empty} MiB`);
await chrome.close();
server.close();
