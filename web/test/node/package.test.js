// SPDX-License-Identifier: Apache-2.0
// What `npm pack` makes is whole: its licence, every file that another one names, and a decoder that runs.
import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { execFileSync, spawnSync } from 'node:child_process';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { caseOf, suite } from './support.js';

const web = fileURLToPath(new URL('../../', import.meta.url));
const skip = spawnSync('npm', ['--version']).status !== 0 ? 'there is no npm (tools/setup.sh web)'
  : !existsSync(join(web, 'made/viewer_markup.js')) && 'there is no made/ (web/build.sh says why)';
const withoutPackages = !existsSync(join(web, 'node_modules/typescript')) && 'there is no typescript: npm ci in web/';
const place = mkdtempSync(join(tmpdir(), 'slf-package-'));
const installed = join(place, 'node_modules/slf-decoder');
after(() => rmSync(place, { recursive: true }));

if (!skip) {
  execFileSync('npm', ['pack', '--silent', '--pack-destination', place], { cwd: web });
  const archive = readdirSync(place).find((name) => name.endsWith('.tgz'));
  mkdirSync(installed, { recursive: true });
  execFileSync('tar', ['-xzf', join(place, archive), '-C', installed, '--strip-components', '1']);
}

const isOfNode = (name) => name.startsWith('slf_node');

test('a package says what it is and under which licence', { skip }, () => {
  assert.deepEqual(readFileSync(join(installed, 'LICENSE')), readFileSync(join(web, '../LICENSE')));
  assert.match(readFileSync(join(installed, 'README.md'), 'utf8'), /SlfDecoder\.create/);
});

test('every file that one of a package names is in it', { skip }, () => {
  const names = /(?:from |import\(|new URL\()'(\.[^']+)'|(?:src|href)="([\w./]+(?<!\.slf))"|\b(node_modules)\b/g;
  let found = 0;
  for (const name of readdirSync(installed, { recursive: true })) {
    if (!/\.(js|ts|mjs|html)$/.test(name)) continue;
    for (const [, module, link, elsewhere] of readFileSync(join(installed, name), 'utf8').matchAll(names)) {
      assert.equal(elsewhere, undefined, `${name} names node_modules`);
      assert.ok(existsSync(join(installed, dirname(name), module ?? link)), `${name}: ${module ?? link}`);
      ++found;
    }
  }
  assert.ok(found > 40, `${found} names`);
});

test('a package decodes', { skip }, () => {
  const { stream, expect: [{ points }] } = caseOf('harmonics');
  writeFileSync(join(place, 'use.mjs'), `
    import { readFileSync } from 'node:fs';
    import { SlfDecoder } from 'slf-decoder';
    import 'slf-decoder/stream';
    console.log((await SlfDecoder.create()).decode(readFileSync(process.argv[2])).positions.length / 3);`);
  const said = execFileSync(process.execPath, ['use.mjs', join(suite, 'streams/harmonics', stream.file)], { cwd: place });
  assert.equal(Number(said), points);
});

test('no file that a browser is given names node', { skip }, () => {
  const { exports } = JSON.parse(readFileSync(join(installed, 'package.json'), 'utf8'));
  for (const name of readdirSync(installed, { recursive: true }))
    if (name.endsWith('.js') && !isOfNode(name))
      assert.doesNotMatch(readFileSync(join(installed, name), 'utf8'), /['"`]node:/, name);
  for (const [entry, { node, default: browser }] of Object.entries(exports))
    if (node) assert.ok(isOfNode(node.slice(2)) && !isOfNode(browser.slice(2)), entry);
});

/** {import: names} that run() finds, of each module that package.json has types of. */
async function namesBy(run) {
  const { exports } = JSON.parse(readFileSync(join(installed, 'package.json'), 'utf8'));
  const entries = Object.keys(exports).filter((entry) => exports[entry].types).map((entry) => join('slf-decoder', entry));
  return Object.fromEntries(await Promise.all(entries.map(async (entry) => [entry, (await run(entry)).sort()])));
}

/** What a bundler of pages finds. */
async function namesOfBrowser(entry) {
  const { build } = await import('esbuild');
  const { metafile } = await build({ stdin: { contents: `export * from '${entry}'`, resolveDir: place }, bundle: true,
    write: false, metafile: true, format: 'esm', platform: 'browser', external: ['*.wasm'], logLevel: 'error', outdir: place });
  return Object.values(metafile.outputs).find((output) => output.entryPoint).exports;
}

function namesOfNode(entry) {
  const script = `import * as all from '${entry}'; console.log(JSON.stringify(Object.keys(all)))`;
  return JSON.parse(execFileSync(process.execPath, ['--input-type=module', '-e', script], { cwd: place }));
}

test('a browser and node are given the same names by each import', { skip: skip || withoutPackages }, async () => {
  const inNode = await namesBy(namesOfNode);
  assert.deepEqual(await namesBy(namesOfBrowser), inNode);
  assert.ok(Object.keys(inNode).length >= 5);
});

test('the types of each import have the names that it gives, and no others', { skip: skip || withoutPackages }, async () => {
  // An object of these keys and no others is what the compiler is asked for.
  const given = Object.entries(await namesBy(namesOfNode)).map(([entry, names], i) => `
    import * as all${i} from '${entry}';
    export const names${i}: { [Name in keyof typeof all${i}]: 1 } = { ${names.map((name) => `${name}: 1`).join(', ')} };`);
  writeFileSync(join(place, 'names.mts'), given.join('\n'));
  for (const [module, resolution] of [['nodenext', 'nodenext'], ['esnext', 'bundler']]) {
    const { status, stdout } = spawnSync(process.execPath, [join(web, 'node_modules/typescript/bin/tsc'), '--ignoreConfig', '--strict',
      '--noEmit', '--target', 'es2022', '--types', '', '--module', module, '--moduleResolution', resolution, 'names.mts'],
    { cwd: place, encoding: 'utf8' });
    assert.equal(status, 0, stdout);
  }
});
