// SPDX-License-Identifier: Apache-2.0
// Makes dist/one_file.html, the template of `slf html`: viewer.html with its style and code in it, the
// code and the decoder packed by xz (lzma.js unpacks them). Prints what each part takes.
import { execFileSync } from 'node:child_process';
import { readFile, writeFile, mkdir } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';
import { build, transform } from 'esbuild';
import { toText } from './base85.js';

const here = new URL('./', import.meta.url),
  web = new URL('../', here);
const text = (name) => readFile(new URL(name, here), 'utf8');

/** One script without imports. */
async function bundle(entry, name) {
  const { outputFiles } = await build({
    entryPoints: [fileURLToPath(new URL(entry, here))],
    bundle: true,
    minify: true,
    write: false,
    format: 'iife',
    globalName: name,
    target: 'es2022',
    charset: 'utf8',
    legalComments: 'none',
    external: ['../made/*'], // this page brings a worker of its own
    define: { 'import.meta.url': '"about:blank"' },
    plugins: [shaders],
  });
  return outputFiles[0].contents;
}

/** Comments and indentation of GLSL are not for browsers. */
const shaders = {
  name: 'shaders',
  setup(builder) {
    builder.onLoad({ filter: /shaders\.js$/ }, async ({ path }) => ({
      contents: (await readFile(path, 'utf8'))
        .replace(/(?<!:)\/\/[^`\n]*/g, '')
        .replace(/\/\*[\s\S]*?\*\//g, '')
        .replace(/\n\s+/g, '\n'),
    }));
  },
};

function withLength(bytes, number = bytes.length) {
  const length = Buffer.alloc(4);
  length.writeUInt32LE(number);
  return Buffer.concat([length, bytes]);
}

const [page, worker, begin] = await Promise.all(
  [['one_file.js', 'slfPage'], ['decode_worker.js', 'slfWorker'], ['one_file_start.js']].map((each) => bundle(...each)),
);
const wasm = await readFile(new URL(process.argv[2] ?? 'slf.wasm', web));
const plain = Buffer.concat([page, worker, wasm].map((each) => withLength(each)));
const packed = withLength(execFileSync('xz', ['--format=raw', '--lzma1=preset=9e,lc=4,lp=0,pb=0', '-c'], { input: plain }), plain.length);
const style = (await transform(await text('viewer.css'), { loader: 'css', minify: true })).code;
const start = Buffer.from(begin).toString();
const policy =
  "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; worker-src blob:; " +
  "style-src 'unsafe-inline'; img-src data: blob:; connect-src blob: data:";

const replace = (html, from, to) => {
  if (!html.includes(from)) throw new Error(`viewer.html has no ${from}`);
  return html.replace(from, () => to);
};
let html = (await text('viewer.html')).replace(/<!--.*?-->\n/gs, '').replace(/\n\s+/g, '\n');
html = replace(
  html,
  '<title>Surface light field</title>',
  `<title>{{slf:title}}</title>\n<meta http-equiv="Content-Security-Policy" content="${policy}">`,
);
html = replace(html, '<link rel="stylesheet" href="viewer.css">', `<style>${style.trim()}</style>`);
html = replace(html, '<script type="module" src="page.js"></script>', `<script>${start.trim()}</script>`);
html = replace(html, '<body class="empty">', '<body>');
html = replace(html, '<img id="poster" alt="" hidden>', '<picture>{{slf:night}}<img id="poster" alt="" src="{{slf:poster}}"></picture>');
html = replace(
  html,
  '</body>',
  [
    '<script type="application/json" id="slf-options">{{slf:options}}</script>',
    `<script type="text/plain" id="slf-code">${toText(packed)}</script>`,
    '<script type="text/plain" id="slf-file">{{slf:file}}</script>\n</body>',
  ].join('\n'),
);

await mkdir(new URL('dist/', web), { recursive: true });
await writeFile(new URL('dist/one_file.html', web), html);
const row = (name, bytes) => console.log(name.padEnd(28), String(bytes).padStart(9));
row('page, minified', page.length);
row('worker, minified', worker.length);
row('decoder', wasm.length);
row('the three, packed', packed.length);
row('the same as text', toText(packed).length);
row('dist/one_file.html', html.length);
