// SPDX-License-Identifier: Apache-2.0
// What each bundler makes of a project's main.js. A builder gives the folder to serve, or an address where it serves
// by itself. Parts: what a bundler that sees no addresses has to be given (docs/web.md).
import { spawn } from 'node:child_process';
import { copyFileSync, mkdirSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

const PAGE = (script) => `<!doctype html><html lang="en"><meta charset="utf-8"><title>A page</title>
<style>body { margin: 0; background: #000 }</style><body><script type="module" src="${script}"></script></body></html>\n`;

/** A bundler of the folder that they are installed in. */
function toolsOf(root) {
  const require = createRequire(join(root, 'package.json'));
  return { path: (name) => require.resolve(name), load: (name) => import(pathToFileURL(require.resolve(name))) };
}

async function viteBuild({ root, dir }) {
  const { build } = await toolsOf(root).load('vite');
  writeFileSync(join(dir, 'index.html'), PAGE('/main.js'));
  await build({ root: dir, configFile: false, logLevel: 'error', build: { target: 'es2022' } });
  return { folder: join(dir, 'dist') };
}

async function viteDev({ root, dir }) {
  const { createServer } = await toolsOf(root).load('vite');
  writeFileSync(join(dir, 'index.html'), PAGE('/main.js'));
  mkdirSync(join(dir, 'public'), { recursive: true });
  copyFileSync(join(root, 'can.slf'), join(dir, 'public/can.slf'));
  const server = await createServer({ root: dir, configFile: false, logLevel: 'error', server: { host: '127.0.0.1', port: 0 } });
  await server.listen();
  return { url: server.resolvedUrls.local[0], close: () => server.close() };
}

async function esbuild({ root, dir }, loader = {}) {
  const { build } = await toolsOf(root).load('esbuild');
  await build({ entryPoints: [join(dir, 'main.js')], outdir: join(dir, 'dist'), bundle: true, minify: true, format: 'esm',
    splitting: true, target: 'es2022', logLevel: 'error', absWorkingDir: dir, loader, jsx: 'automatic' });
  writeFileSync(join(dir, 'dist/index.html'), PAGE('main.js'));
  return { folder: join(dir, 'dist') };
}

async function webpack({ root, dir }) {
  const { default: pack } = await toolsOf(root).load('webpack');
  const stats = await new Promise((done, failed) => pack({ mode: 'production', context: dir, entry: './main.js',
    output: { path: join(dir, 'dist') }, experiments: { outputModule: false } }, (error, made) => (error ? failed(error) : done(made))));
  if (stats.hasErrors()) throw new Error(stats.toString('errors-only'));
  writeFileSync(join(dir, 'dist/index.html'), PAGE('main.js'));
  return { folder: join(dir, 'dist') };
}

async function rollup({ root, dir }, assets) {
  const tools = toolsOf(root);
  const { rollup: roll } = await tools.load('rollup'), { nodeResolve } = await tools.load('@rollup/plugin-node-resolve');
  const plugins = [nodeResolve({ browser: true })];
  if (assets) plugins.push((await tools.load('@web/rollup-plugin-import-meta-assets')).importMetaAssets());
  const bundle = await roll({ input: join(dir, 'main.js'), plugins, onLog() {} });
  await bundle.write({ dir: join(dir, 'dist'), format: 'es' });
  writeFileSync(join(dir, 'dist/index.html'), PAGE('main.js'));
  return { folder: join(dir, 'dist') };
}

async function parcel({ root, dir }) {
  writeFileSync(join(dir, 'index.html'), PAGE('main.js'));
  const program = join(root, 'node_modules/parcel/lib/bin.js');
  await finished(process.execPath, [program, 'build', 'index.html', '--dist-dir', 'dist', '--no-source-maps', '--no-cache'], dir);
  return { folder: join(dir, 'dist') };
}

function finished(command, words, cwd) {
  return new Promise((done, failed) => {
    const run = spawn(command, words, { cwd, stdio: ['ignore', 'pipe', 'pipe'] });
    let said = '';
    for (const stream of [run.stdout, run.stderr]) stream.on('data', (text) => { said += text; });
    run.on('close', (code) => (code ? failed(new Error(said)) : done()));
  });
}

/** Versions of three.js that a loader has to draw with; the others are of package.json. */
const OLD_THREE = ['0.150.0', '0.160.0', '0.170.0'];
const INLINE = { head: "import { wasm } from 'slf-decoder/inline';\n", parts: 'wasm' };

/** name: build, what a page needs beside its ten lines, and whether it takes JSX as it comes; package: of the project;
 *  three, only: its version, and the one page of it */
export const BUILDERS = {
  'vite build': { build: viteBuild, jsx: true },
  'vite dev': { build: viteDev, jsx: true },
  'webpack': { build: webpack },
  'parcel': { build: parcel, jsx: true, package: { '@parcel/resolver-default': { packageExports: true } } },
  'rollup, assets plugin': { build: (project) => rollup(project, true) },
  'rollup, inline': { build: (project) => rollup(project, false), ...INLINE },
  'esbuild, inline': { build: esbuild, jsx: true, ...INLINE },
  'esbuild, file loader': { build: (project) => esbuild(project, { '.wasm': 'file' }),
    head: "import wasm from 'slf-decoder/slf.wasm';\n", parts: 'wasm: new URL(wasm, import.meta.url)' },
  ...Object.fromEntries(OLD_THREE.map((three) => [`three ${three}`, { build: esbuild, three, only: 'three.js', ...INLINE }])),
};
