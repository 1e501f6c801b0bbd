// SPDX-License-Identifier: Apache-2.0
// Units of streams that arrive, by their bytes alone. Spec 7.1, 7.1.2.
import assert from 'node:assert/strict';
import { existsSync, readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { moves, walkUnits } from '../../viewer/stream_units.js';

const GOLDENS = fileURLToPath(new URL('../../../conformance/streams', import.meta.url));
const goldens = readdirSync(GOLDENS)
  .filter((name) => existsSync(join(GOLDENS, name, 'stream.slf')))
  .map((name) => ({ name, bytes: new Uint8Array(readFileSync(join(GOLDENS, name, 'stream.slf'))) }));

test('every golden stream is units up to its end', () => {
  let still = 0;
  for (const { name, bytes } of goldens) {
    if (moves(bytes)) continue;
    ++still;
    assert.equal(walkUnits(bytes).end, bytes.length, name);
    assert.ok(walkUnits(bytes.subarray(0, bytes.length - 1)).end < bytes.length - 1, name);
  }
  assert.ok(still > 100);
});

test('streams of frames are told by the unit behind the sequence', () => {
  const ends = 'feature-empty-prefix'; // behind its sequence
  for (const { name, bytes } of goldens) assert.equal(moves(bytes), name === ends ? null : name.startsWith('frames-'), name);
});

test('the length of a sequence unit stands behind the version', () => {
  const { bytes } = goldens.find(({ name }) => name === 'version-of-a-long-sequence');
  assert.ok(bytes[11] >= 0x80); // more than one byte
  for (let size = 8; size < 11; ++size) assert.equal(walkUnits(bytes.subarray(0, size)).end, 0);
});
