// SPDX-License-Identifier: Apache-2.0
// Makes made/, what a package has beside the sources: workers in one piece (start_worker.js), the decoder
// within a module (slf-decoder/inline), the viewer's markup and style (slf_viewer.js). Prints what each takes.
import { mkdir, readFile, writeFile } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import { build, transform } from 'esbuild';

const web = new URL('./', import.meta.url);
const text = (name) => readFile(new URL(name, web), 'utf8');

/** A classic script: the decoder comes to it as a module that is compiled already. */
async function worker(entry) {
  const { outputFiles } = await build({
    entryPoints: [fileURLToPath(new URL(entry, web))],
    bundle: true,
    minify: true,
    write: false,
    format: 'iife',
    target: 'es2022',
    legalComments: 'none',
    define: { 'import.meta.url': '"about:blank"' },
  });
  return `// Made by build_package.mjs of ${entry}.\nexport const text = ${JSON.stringify(outputFiles[0].text)};\n`;
}

async function inline() {
  const packed = gzipSync(await readFile(new URL('slf.wasm', web)), { level: 9 }).toString('base64');
  return `// Made by build_package.mjs: slf.wasm, packed.
const packed = Uint8Array.from(atob('${packed}'), (c) => c.charCodeAt(0));
const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
export const wasm = new Response(stream).arrayBuffer().then((bytes) => WebAssembly.compile(bytes));
wasm.catch(() => {}); // said to whoever awaits it
`;
}

/** The elements of viewer.html for a root of their own: the landmarks of a page are the page's. */
async function markup() {
  const html = await text('viewer/viewer.html');
  const body = html
    .slice(html.indexOf('<main'), html.indexOf('</body>'))
    .replace(/\n\s*/g, '')
    .replace('<main>', '<div class="whole">')
    .replace(/<nav /, '<div role="toolbar" ')
    .replace(/<(aside|section) (?=id=)/g, '<$1 role="group" ')
    .replace(/<header /, '<div ')
    .replace(/<\/(main|nav|header)>/g, '</div>');
  const css = (await transform(await text('viewer/viewer.css'), { loader: 'css', minify: true })).code;
  return `// Made by build_package.mjs of viewer.html and viewer.css.
export const markup = ${JSON.stringify(body)};
export const style = ${JSON.stringify(css)};
`;
}

const parts = {
  'decode_worker_text.js': await worker('viewer/decode_worker.js'),
  'slf_worker_text.js': await worker('slf_worker_service.js'),
  'inline.js': await inline(),
  'viewer_markup.js': await markup(),
};
await mkdir(new URL('made/', web), { recursive: true });
for (const [name, content] of Object.entries(parts)) {
  await writeFile(new URL(`made/${name}`, web), content);
  console.log(`made/${name}`.padEnd(28), String(content.length).padStart(9), String(gzipSync(content).length).padStart(9));
}
