// SPDX-License-Identifier: Apache-2.0
// What the browser tests share: files made by the program, a static server, Chromium, comparisons.
import { execFileSync } from 'node:child_process';
import { createReadStream, existsSync, mkdtempSync, readFileSync, rmSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { extname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { inflateSync } from 'node:zlib';
import { chromium } from 'playwright-core';

export const web = resolve(fileURLToPath(new URL('../../', import.meta.url)));
export const repository = resolve(web, '..');
const program = process.env.SLF_PROGRAM ?? join(repository, 'build/bin/slf');
const browser =
  process.env.CHROMIUM ?? ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find(existsSync);

/** Why nothing can be tested here; undefined where all is there. */
export const missing = !existsSync(program)
  ? `the program slf (${program}); set SLF_PROGRAM`
  : !browser
    ? 'Chromium; set CHROMIUM'
    : !existsSync(join(web, 'slf.wasm'))
      ? 'web/slf.wasm; npm run build'
      : undefined;
export const skip = missing && `skipped: needs ${missing}`;

export const slf = (...args) =>
  execFileSync(program, args.map(String), { stdio: ['ignore', 'pipe', 'pipe'], maxBuffer: 1 << 26 });

/** A folder that goes with the process. */
export function folder() {
  const made = mkdtempSync(join(tmpdir(), 'slf-browser-'));
  process.on('exit', () => rmSync(made, { recursive: true, force: true }));
  return made;
}

/** A can of some 20,000 points with reflections, its capture, and five views of it by the C++ renderer. */
export function makeCan(size = 320) {
  const dir = folder(),
    capture = join(dir, 'capture'),
    file = join(dir, 'can.slf');
  slf('synth', 'can', '-o', capture, '--size', '96x96');
  slf('encode', capture, '-o', file, '--effort', 1, '--quiet');
  return { dir, capture, ...withViews(file, size) };
}

/** The can as Gaussian splats of degree 2. */
export function makeSplats(size = 320) {
  const { dir, file } = makeCan(size),
    ply = join(dir, 'splats.ply'),
    splats = join(dir, 'splats.slf');
  slf('export', file, '-o', ply, '--degree', 2, '--quiet');
  slf('encode', ply, '-o', splats, '--quiet');
  return { dir, ...withViews(splats, size) };
}

/** A file, and five views of it by the C++ renderer. */
export function withViews(file, size) {
  const views = [0, 1, 2, 3, 4].map((i) => ({ azimuth: 20 + 72 * i, elevation: 15 * i - 20 }));
  const pictures = views.map((view) => rendered(file, view, size));
  return { file, bytes: readFileSync(file), views, pictures, size };
}

let pictures; // a folder

/** The picture of `slf render`. */
export function rendered(file, { azimuth, elevation }, size, ...options) {
  pictures ??= folder();
  const png = join(pictures, 'view.png'),
    sides = `${size}x${size}`;
  slf('render', file, '--azimuth', azimuth, '--elevation', elevation, '--size', sides, '-o', png, '--quiet', ...options);
  return readPng(readFileSync(png));
}

const TYPES = {
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.css': 'text/css',
  '.json': 'application/json',
  '.wasm': 'application/wasm',
  '.png': 'image/png',
};

/**
 * A static server that has web/ below a path of its own, and other folders beside it.
 * @param {object} folders  name: folder
 * @param {object} slow  name of a file: {bytes of a chunk, ms between, until: bytes after which it cuts off, or
 *   where silent goes on without a word; silent from byte 0 on there is no header either}
 */
export async function serve(folders = {}, slow = {}) {
  const roots = { 'some/path/web': web, ...folders };
  const server = createServer((request, response) => {
    const path = decodeURIComponent(new URL(request.url, 'http://x').pathname).slice(1);
    const [name, root] = Object.entries(roots).find(([each]) => path.startsWith(`${each}/`)) ?? [];
    const file = name && resolve(root, path.slice(name.length + 1));
    if (!file?.startsWith(root) || !existsSync(file) || !statSync(file).isFile()) return response.writeHead(404).end();
    response.writeHead(200, {
      'content-type': TYPES[extname(file)] ?? 'application/octet-stream',
      'content-length': statSync(file).size,
    });
    const pace = slow[path.split('/').pop()];
    if (pace) return trickle(readFileSync(file), pace, response);
    createReadStream(file).pipe(response);
  });
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  const url = `http://127.0.0.1:${server.address().port}`;
  return {
    url,
    page: `${url}/some/path/web/viewer/viewer.html`,
    three: `${url}/some/path/web/viewer/three.html`,
    close: () => {
      server.closeAllConnections();
      server.close();
    },
  };
}

async function trickle(bytes, { chunk, wait, until = Infinity, silent = false }, response) {
  for (let at = 0; at < bytes.length; at += chunk) {
    if (at >= until) return silent || response.destroy();
    response.write(bytes.subarray(at, at + chunk));
    await new Promise((done) => setTimeout(done, wait));
  }
  response.end();
}

/** WebGL by SwiftShader: the flags that Chromium wants named. */
export const launch = () =>
  chromium.launch({
    executablePath: browser,
    timeout: 180000,
    args: [
      '--no-sandbox',
      '--use-angle=swiftshader',
      '--enable-unsafe-swiftshader',
      '--disable-dev-shm-usage',
      '--js-flags=--expose-gc',
    ],
  });

/** A page that remembers what went wrong on it and whom it asked. */
export async function newPage(chrome, options = {}) {
  const page = await chrome.newPage({ viewport: { width: 480, height: 480 }, ...options });
  page.setDefaultTimeout(180000);
  page.wrong = [];
  page.asked = [];
  page.on('pageerror', (error) => page.wrong.push(String(error)));
  page.on('request', (request) => page.asked.push(request.url()));
  return page;
}

/** Until the viewer shows the whole file or says what is wrong. @returns the state */
export async function settled(page) {
  await page.waitForFunction(() => /^(ready|failed)/.test(document.body.dataset.state ?? ''));
  return page.evaluate(() => document.body.dataset.state);
}

/** The viewer's picture of a pose (null: as it is) on its canvas, as its own screenshot has it. */
export async function pictureOf(page, pose, size) {
  await page.setViewportSize({ width: size, height: size });
  const base64 = await page.evaluate(
    async ([view]) => {
      const { viewer } = window,
        parts = view && (await import(new URL('view.js', document.baseURI)));
      viewer.spin(0);
      if (view) viewer.controls.pose = viewer.stage.pose = parts.fittingPose(viewer.stage.field, view);
      const blob = await viewer.stage.screenshot();
      return btoa(Array.from(new Uint8Array(await blob.arrayBuffer()), (b) => String.fromCharCode(b)).join(''));
    },
    [pose],
  );
  return readPng(Buffer.from(base64, 'base64'));
}

/** The picture of the three.js page's object from a pose. */
export async function threePictureOf(page, view, side) {
  const base64 = await page.evaluate(
    async ([pose, size]) => {
      const { field, renderer, THREE } = window,
        { axesOf, fittingPose } = await import(new URL('view.js', document.baseURI));
      const scene = new THREE.Scene(),
        camera = new THREE.PerspectiveCamera(30, 1, 0.01, 100);
      scene.background = new THREE.Color('#808080');
      field.position.set(0, 0, 0);
      field.quaternion.identity();
      field.scale.setScalar(1);
      scene.add(field);
      const at = fittingPose(field.packed, pose),
        [right, down, forward] = axesOf(at, field.packed.up);
      const eye = at.target.map((v, k) => v - at.distance * forward[k]);
      camera.matrixAutoUpdate = false;
      camera.matrix
        .makeBasis(...[right, down.map((v) => -v), forward.map((v) => -v)].map((v) => new THREE.Vector3(...v)))
        .setPosition(...eye);
      camera.updateMatrixWorld(true);
      renderer.setPixelRatio(1);
      renderer.setSize(size, size, false);
      renderer.render(scene, camera);
      return renderer.domElement.toDataURL().split(',')[1];
    },
    [view, side],
  );
  return readPng(Buffer.from(base64, 'base64'));
}

/** 8 bit PNG without interlace, grey to RGBA. @returns {{width, height, data}} RGB */
export function readPng(bytes) {
  const parts = [];
  let width, height, channels;
  for (let at = 8; at < bytes.length;) {
    const length = bytes.readUInt32BE(at),
      type = bytes.toString('latin1', at + 4, at + 8),
      body = bytes.subarray(at + 8, at + 8 + length);
    if (type === 'IHDR') {
      [width, height] = [body.readUInt32BE(0), body.readUInt32BE(4)];
      channels = { 2: 3, 6: 4 }[body[9]];
      if (body[8] !== 8 || !channels || body[12] !== 0) throw new Error('a PNG of another kind');
    }
    if (type === 'IDAT') parts.push(body);
    at += 12 + length;
  }
  const rows = inflateSync(Buffer.concat(parts)),
    stride = width * channels,
    data = Buffer.alloc(width * height * 3);
  let above = Buffer.alloc(stride);
  for (let y = 0; y < height; ++y) {
    const filter = rows[y * (stride + 1)],
      row = Buffer.from(rows.subarray(y * (stride + 1) + 1, (y + 1) * (stride + 1)));
    for (let i = 0; i < stride; ++i) {
      const a = i >= channels ? row[i - channels] : 0,
        b = above[i],
        c = i >= channels ? above[i - channels] : 0;
      row[i] += [0, a, b, (a + b) >> 1, paeth(a, b, c)][filter];
    }
    for (let x = 0; x < width; ++x) row.copy(data, (y * width + x) * 3, x * channels, x * channels + 3);
    above = row;
  }
  return { width, height, data };
}

function paeth(a, b, c) {
  const p = a + b - c,
    [pa, pb, pc] = [a, b, c].map((v) => Math.abs(p - v));
  return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
}

/** dB over all pixels of two pictures of one size. */
export function psnr(a, b) {
  if (a.width !== b.width || a.height !== b.height)
    throw new Error(`${a.width} x ${a.height} against ${b.width} x ${b.height}`);
  let sum = 0;
  for (let i = 0; i < a.data.length; ++i) sum += (a.data[i] - b.data[i]) ** 2;
  return 10 * Math.log10((255 ** 2 * a.data.length) / sum);
}

/** Takes the graphics context of the viewer's canvas away, and gives it back. */
export async function loseContext(page) {
  await page.evaluate(async () => {
    const { gl } = window.viewer.stage,
      lost = gl.getExtension('WEBGL_lose_context');
    const once = (type) => new Promise((done) => gl.canvas.addEventListener(type, done, { once: true }));
    const [gone, back] = [once('webglcontextlost'), once('webglcontextrestored')];
    lost.loseContext();
    await gone;
    await new Promise((done) => setTimeout(done, 200)); // the event is over: now it may come back
    lost.restoreContext();
    await back;
  });
}
