// SPDX-License-Identifier: Apache-2.0
// The conformance suite against the decoder in WebAssembly: the same digests, the same refusals.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { SlfDecoder, SlfError } from '../../slf_node.js';
import { cases, digest, optionsOf } from './support.js';

const builds = {
  simd: new URL('../../slf.wasm', import.meta.url),
  scalar: new URL('../../slf_scalar.wasm', import.meta.url),
};
/** What this build has left out is refused as that, not decoded: nothing else may be skipped. */
const LEFT_OUT = { draco: /^draco$/, textures: /^texture-/ };
const REFUSED_ELSEWHERE = /^(draco|hevc|texture)/;

function isLeftOut(id) { return Object.values(LEFT_OUT).some((pattern) => pattern.test(id)); }

/** Same points, components and normals as the case says. */
function check(field, expect) {
  assert.equal(field.points, expect.points);
  assert.equal(field.components, expect.components);
  assert.equal(digest(field.positions), expect.positions_sha256, 'positions');
  if (field.components > 0) assert.equal(digest(Int32Array.from(field.values)), expect.components_sha256, 'components');
  if (expect.normals_sha256 && field.points > 0) assert.equal(digest(field.octahedral), expect.normals_sha256, 'normals');
}

for (const [build, url] of Object.entries(builds)) {
  const decoder = await SlfDecoder.create({ wasm: url });
  for (const one of cases('streams')) {
    const skip = isLeftOut(one.id) && 'Draco and textures are left out of this build';
    test(`${build}: streams/${one.id}`, { skip }, () => {
      for (const expect of one.expect) {
        if (expect.frame > 0) continue; // this decoder gives the first
        const field = decoder.decode(one.bytes, optionsOf(expect));
        check(field, expect);
        field.release();
      }
    });
    if (skip)
      test(`${build}: streams/${one.id} is refused by name`, () => {
        assert.throws(() => decoder.decode(one.bytes), (error) => error instanceof SlfError && error.code === 'UNSUPPORTED');
      });
  }
  for (const one of cases('refused')) {
    test(`${build}: refused/${one.id}`, () => {
      const refuse = () => (one.refuse.by === 'info' ? decoder.info(one.bytes) : decoder.decode(one.bytes));
      assert.throws(refuse, (error) => {
        assert.ok(error instanceof SlfError, String(error));
        assert.notEqual(error.code, 'INTERNAL', error.message);
        if (error.code === 'UNSUPPORTED' && REFUSED_ELSEWHERE.test(one.id)) return true;
        assert.equal(error.element, one.refuse.element);
        return true;
      });
    });
  }
}
