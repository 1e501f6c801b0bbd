// SPDX-License-Identifier: Apache-2.0
// What xz packs the one-file page's code unpacks.
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { unpack } from '../../viewer/lzma.js';

const skip = spawnSync('xz', ['--version']).status !== 0 && 'there is no xz';
const packed = (input) => execFileSync('xz', ['--format=raw', '--lzma1=preset=9e,lc=4,lp=0,pb=0', '-c'], { input, maxBuffer: 1 << 26 });

/** Bytes of a linear congruence: nothing in them repeats. */
function noise(length, seed = 1) {
  const out = Buffer.alloc(length);
  for (let i = 0, x = seed; i < length; ++i) {
    x = (Math.imul(x, 1664525) + 1013904223) >>> 0;
    out[i] = x >>> 24;
  }
  return out;
}

const block = noise(5000, 7);
const CASES = {
  'a byte': Buffer.from([200]),
  'one byte over and over: the longest matches': Buffer.alloc(100_000, 65),
  'noise: literals alone': noise(20_000),
  'a block that comes again after 2, 20 and 700 kB: all kinds of distances':
    Buffer.concat([block, noise(2000, 2), block, noise(20_000, 3), block, noise(700_000, 4), block]),
  'columns that repeat from four places: distances that come again':
    Buffer.from(Array.from({ length: 60_000 }, (_, i) => (i % 7 === i % 11 ? i & 255 : [3, 141, 59, 26][i % 4] + (i % 5)))),
  'the decoder': readFileSync(new URL('../../slf.wasm', import.meta.url)),
};

for (const [name, bytes] of Object.entries(CASES))
  test(name, { skip }, () => assert.ok(bytes.equals(unpack(packed(bytes), bytes.length))));
