// SPDX-License-Identifier: Apache-2.0
// Packs the package, installs it in empty projects and draws what bundlers make of pages/ in Chromium.
//     node web/test/bundlers/run.mjs [part of a bundler's name]
// Needs the program slf, Chromium and npm's registry; 77 and a line where one of them is missing.
import { execFileSync, spawnSync } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { folder, launch, missing, newPage, readPng, slf, web } from '../browser/support.mjs';
import { BUILDERS } from './builders.mjs';
import { serveFolder } from './serve_folder.mjs';

const here = fileURLToPath(new URL('./', import.meta.url)), wanted = process.argv[2] ?? '';
const tools = JSON.parse(readFileSync(join(here, 'tools.json'), 'utf8'));
const pages = readdirSync(join(here, 'pages')).filter((name) => name.endsWith('.js'));

function skipped(why) {
  console.log(`web/test/bundlers: skipped, ${why}`);
  process.exit(77);
}

function npm(cwd, ...words) {
  try {
    return execFileSync('npm', [...words, '--no-audit', '--no-fund', '--silent', '--ignore-scripts'], { cwd, timeout: 300_000 });
  } catch (error) {
    if (words[0] !== 'install') throw error;
    return skipped(`npm did not get ${words.slice(1).join(' ') || 'the bundlers of tools.json'}`);
  }
}

if (missing) skipped(`there is no ${missing}`);
if (!existsSync(join(web, 'made/inline.js'))) skipped('there is no made/inline.js (web/build.sh)');
if (spawnSync('npm', ['view', 'esbuild', 'version'], { timeout: 20_000 }).status !== 0)
  skipped('the registry of npm does not answer');

const root = folder(), { three } = JSON.parse(readFileSync(join(web, 'package.json'), 'utf8')).devDependencies;
const REACT = ['react@19.3.1', 'react-dom@19.3.1'], JSX = 'react.js'; // the page of examples/react
writeFileSync(join(root, 'package.json'), JSON.stringify({ private: true, devDependencies: tools }));
npm(root, 'install');
slf('synth', 'can', '-o', join(root, 'capture'), '--size', '64x64');
slf('encode', join(root, 'capture'), '-o', join(root, 'can.slf'), '--effort', 1, '--quiet');
npm(web, 'pack', '--pack-destination', root);
const archive = join(root, readdirSync(root).find((name) => name.endsWith('.tgz')));

/** An empty project with the package and three in it. */
function project(name, more = {}, version = three) {
  const dir = join(root, name.replace(/\W+/g, '_'));
  mkdirSync(dir);
  writeFileSync(join(dir, 'package.json'), JSON.stringify({ name: 'a-page', private: true, type: 'module', ...more }));
  npm(dir, 'install', archive, `three@${version}`, ...REACT);
  cpSync(join(web, 'examples/react'), dir, { recursive: true });
  return dir;
}

/** What a page shows: the share of its pixels that are not black, and the errors that it has met. */
async function look(chrome, url) {
  const page = await newPage(chrome, { viewport: { width: 400, height: 300 } }), errors = [];
  page.on('pageerror', (error) => errors.push(error.message));
  await page.goto(url);
  const shown = () => window.ready || document.querySelector('slf-viewer')?.state === 'ready';
  await page.waitForFunction(shown, undefined, { timeout: 60_000 }).catch((error) => errors.push(error.message));
  const { data } = readPng(await page.screenshot());
  let lit = 0;
  for (let i = 0; i < data.length; i += 3) lit += data[i] + data[i + 1] + data[i + 2] > 24;
  await page.close();
  return { lit: lit / (data.length / 3), errors };
}

async function draws(chrome, name, page, served) {
  served.sent?.();
  const { lit, errors } = await look(chrome, served.url), good = lit > 0.05 && errors.length === 0;
  const { files, bytes } = served.sent?.() ?? {};
  const size = bytes ? `${files} files, ${(bytes / 1000).toFixed(0)} kB packed` : '';
  console.log(`${good ? 'ok' : 'FAILED'}  ${name.padEnd(24)} ${page.padEnd(12)} ${(100 * lit).toFixed(0)} % drawn  ${size}`);
  for (const error of errors) console.log(`        ${error.split('\n')[0]}`);
  return good;
}

async function bundled(chrome, name, { build, head = '', parts = '', jsx, package: more, three: version, only }) {
  const dir = project(name, more, version);
  let good = 0;
  for (const page of pages.filter((each) => (only ? each === only : jsx || each !== JSX))) {
    ++all;
    const source = head + readFileSync(join(here, 'pages', page), 'utf8').replace('/* parts */', parts);
    writeFileSync(join(dir, 'main.js'), source);
    let made;
    try {
      made = await build({ root, dir });
      if (made.folder) {
        cpSync(join(root, 'can.slf'), join(made.folder, 'can.slf'));
        made = await serveFolder(made.folder);
      }
      good += await draws(chrome, name, page, made);
    } catch (error) {
      console.log(`FAILED  ${name.padEnd(24)} ${page}: ${error.message.slice(0, 2000)}`);
    } finally {
      await made?.close?.();
    }
  }
  return good;
}

/** Unbundled: code of one origin, by an import map, in a page of another. */
async function mapped(chrome) {
  const name = 'import map', dir = project(name), code = await serveFolder(dir), own = join(dir, 'page');
  mkdirSync(own);
  cpSync(join(root, 'can.slf'), join(own, 'can.slf'));
  const at = (path) => `${code.url}/node_modules/${path}`;
  const imports = { three: at('three/build/three.module.js'), 'slf-decoder/worker': at('slf-decoder/slf_worker.js'),
    'slf-decoder/viewer/': at('slf-decoder/viewer/') };
  const served = await serveFolder(own);
  let good = 0;
  for (const page of pages.filter((each) => each !== JSX)) {
    ++all;
    cpSync(join(here, 'pages', page), join(own, 'main.js'));
    writeFileSync(join(own, 'index.html'), `<!doctype html><style>body { margin: 0; background: #000 }</style><body>
<script type="importmap">${JSON.stringify({ imports })}</script><script type="module" src="main.js"></script>`);
    code.sent();
    good += await draws(chrome, name, page, { url: served.url, sent: code.sent });
  }
  code.close();
  served.close();
  return good;
}

/** examples/plain as it is, beside the package. */
async function plain(chrome) {
  const dir = project('plain example');
  cpSync(join(web, 'examples/plain/index.html'), join(dir, 'index.html'));
  cpSync(join(root, 'can.slf'), join(dir, 'can.slf'));
  const served = await serveFolder(dir);
  ++all;
  const good = await draws(chrome, 'plain example', 'index.html', served);
  served.close();
  return good;
}

const chrome = await launch();
let good = 0, all = 0;
for (const [name, builder] of Object.entries(BUILDERS).filter(([each]) => each.includes(wanted)))
  good += await bundled(chrome, name, builder);
if ('import map'.includes(wanted)) good += await mapped(chrome);
if ('plain example'.includes(wanted)) good += await plain(chrome);
await chrome.close();
console.log(`${good} passed, ${all - good} failed`);
process.exit(good === all ? 0 : 1);
