// SPDX-License-Identifier: Apache-2.0
// The types of the modules agree with how they are used. Needs the packages of npm.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { existsSync } from 'node:fs';
import { spawnSync } from 'node:child_process';
import { fileURLToPath } from 'node:url';

const path = (name) => fileURLToPath(new URL(name, import.meta.url));
const compiler = path('../../node_modules/.bin/tsc');
const skip = !existsSync(compiler) && 'there is no typescript: npm ci in web/';

test('what the documentation shows compiles, and what it forbids does not', { skip }, () => {
  const { status, stdout, stderr } = spawnSync(compiler, ['-p', path('../types/tsconfig.json')], { encoding: 'utf8' });
  assert.equal(status, 0, stdout + stderr);
});

test('every name that a module of the viewer declares is there', { skip }, async () => {
  const { packField, ViewerError, buffersOf } = await import('../../viewer/packed_field.js');
  for (const one of [packField, ViewerError, buffersOf]) assert.equal(typeof one, 'function');
  const { SLFLoader } = await import('../../viewer/SLFLoader.js');
  for (const name of ['setPart', 'stream', 'parse', 'load', 'loadAsync'])
    assert.equal(typeof SLFLoader.prototype[name], 'function', name);
  const { SurfaceLightField } = await import('../../viewer/surface_light_field.js');
  assert.equal(typeof SurfaceLightField.prototype.dispose, 'function');
  const { Viewer } = await import('../../viewer/viewer.js');
  for (const name of ['open', 'reset', 'fit', 'spin']) assert.equal(typeof Viewer.prototype[name], 'function', name);
});
