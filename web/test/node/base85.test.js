// SPDX-License-Identifier: Apache-2.0
// The text that a one-file page has its code in: base85.js.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { fromText, toText } from '../../viewer/base85.js';

test('any bytes come back, five characters for four of them, and none ends an element of a page', () => {
  for (const length of [0, 1, 3, 4, 5, 4096]) {
    const bytes = Uint8Array.from({ length }, (_, i) => (i * i * 7 + 13 * i + 251) & 255), text = toText(bytes), back = fromText(text);
    assert.equal(text.length, 5 * Math.ceil(length / 4));
    assert.deepEqual(back.subarray(0, length), bytes);
    assert.ok(back.subarray(length).every((byte) => byte === 0));
    assert.match(text, /^[!-;=-~]*$/);
  }
  for (const byte of [0, 255, 128]) assert.deepEqual(fromText(toText(new Uint8Array(8).fill(byte))), new Uint8Array(8).fill(byte));
});
