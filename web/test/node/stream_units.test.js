// SPDX-License-Identifier: Apache-2.0
// Whether a stream that arrives moves, by its bytes alone. Spec 7.1.2, 7.13.
import assert from 'node:assert/strict';
import { existsSync, readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { moves } from '../../viewer/stream_units.js';

const GOLDENS = fileURLToPath(new URL('../../../conformance/streams', import.meta.url));
const goldens = readdirSync(GOLDENS)
  .filter((name) => existsSync(join(GOLDENS, name, 'stream.slf')))
  .map((name) => ({ name, bytes: new Uint8Array(readFileSync(join(GOLDENS, name, 'stream.slf'))) }));

test('streams of frames are told by the unit behind the sequence', () => {
  const ends = 'feature-empty-prefix'; // behind its sequence
  for (const { name, bytes } of goldens) assert.equal(moves(bytes), name === ends ? null : name.startsWith('frames-'), name);
});

test('the length of a sequence unit stands behind the version', () => {
  const { bytes } = goldens.find(({ name }) => name === 'version-of-a-long-sequence');
  assert.ok(bytes[11] >= 0x80); // more than one byte
  for (let size = 8; size < bytes.length; ++size) if (moves(bytes.subarray(0, size)) !== null) assert.equal(moves(bytes.subarray(0, size)), false);
  assert.equal(moves(bytes.subarray(0, 11)), null);
});
