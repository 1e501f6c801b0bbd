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
const place = mkdtempSync(join(tmpdir(), 'slf-package-'));
const installed = join(place, 'node_modules/slf-decoder');
after(() => rmSync(place, { recursive: true }));

if (!skip) {
  execFileSync('npm', ['pack', '--silent', '--pack-destination', place], { cwd: web });
  const archive = readdirSync(place).find((name) => name.endsWith('.tgz'));
  mkdirSync(installed, { recursive: true });
  execFileSync('tar', ['-xzf', join(place, archive), '-C', installed, '--strip-components', '1']);
}

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
    if (name.endsWith('.js') && name !== 'slf_node.js')
      assert.doesNotMatch(readFileSync(join(installed, name), 'utf8'), /['"`]node:/, name);
  for (const [entry, { node, default: browser }] of Object.entries(exports))
    if (node) assert.ok(node === './slf_node.js' && browser !== node, entry);
});
