// SPDX-License-Identifier: Apache-2.0
// Every text of the viewer stands in every language, and no language has one that the viewer lacks.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { readdirSync, readFileSync } from 'node:fs';

const viewer = new URL('../../viewer/', import.meta.url);
const text = (name) => readFileSync(new URL(name, viewer), 'utf8');
const ENTITIES = { '&amp;': '&', '&lt;': '<', '&gt;': '>', '&quot;': '"' };

/** What stands in the page: texts between tags, and those of attributes. */
function ofPage() {
  const html = text('viewer.html'), body = html.slice(html.indexOf('<main'));
  return [...body.matchAll(/>([^<]+)<|(?:aria-label|title|alt)="([^"]+)"/g)]
    .map(([, between, attribute]) => (between ?? attribute).trim().replace(/&\w+;/g, (e) => ENTITIES[e]))
    .filter((each) => /\p{L}{2}/u.test(each) && each !== '.slf');
}

const languages = readdirSync(new URL('languages/', viewer));
const code = readdirSync(viewer).filter((name) => /\.js$/.test(name)).map(text).join('\n');

for (const name of languages)
  test(`${name} says all that the page says`, async () => {
    const { default: words } = await import(new URL(`languages/${name}`, viewer));
    for (const each of ofPage()) assert.ok(Object.hasOwn(words, each), each);
    for (const [key, said] of Object.entries(words)) {
      assert.ok(said.length > 0, key);
      assert.equal(said.split('{}').length, key.split('{}').length, key);
    }
  });

test('every sentence of an error stands in every language', async () => {
  const HOLE = /\$\{[^}]*\}/g;
  const said = [...code.matchAll(/new ViewerError\(\s*'[\w-]+',\s*(['"`])(.*?)\1\s*[,)]/gs)].map((found) => found[2].replace(HOLE, '{}'));
  assert.ok(said.length > 15);
  for (const name of languages) {
    const { default: words } = await import(new URL(`languages/${name}`, viewer));
    for (const each of said) assert.ok(Object.hasOwn(words, each), `${name}: ${each}`);
  }
});

test('every text of a language is said somewhere', async () => {
  const { default: words } = await import(new URL('languages/de.js', viewer));
  const html = text('viewer.html');
  const holes = code.replace(/\$\{[^`]*?\}(?=[^`]*`)/g, '{}');
  for (const key of Object.keys(words)) {
    const sought = key.replaceAll("'", "\\'");
    assert.ok([key, sought].some((each) => html.includes(each) || code.includes(each) || holes.includes(each)) || key.includes('{}'), key);
  }
});

test('all languages have the same texts', async () => {
  const keys = await Promise.all(languages.map(async (name) =>
    Object.keys((await import(new URL(`languages/${name}`, viewer))).default).sort()));
  for (const each of keys) assert.deepEqual(each, keys[0]);
});

test('a number in a text, a language that is none, and a region', async () => {
  const { Words, wordsOf, ENGLISH } = await import('../../viewer/words.js');
  const words = await wordsOf(['tlh', 'de-CH', 'fr']);
  assert.equal(words.language, 'de');
  assert.equal(words.t('1,607 points'), '1,607 Punkte');
  assert.equal(words.t(`+${words.decimal(0.5, 1)} stops`), '+0,5 Blenden');
  assert.deepEqual([7.4444, 1234].map((each) => ENGLISH.decimal(each, 2)), ['7.44', '1234.00']);
  assert.equal(words.t('constructor'), 'constructor');
  assert.equal(new Words('en', {}).t('Help'), 'Help');
  assert.equal(await wordsOf(['constructor', '__proto__']), ENGLISH);
});
