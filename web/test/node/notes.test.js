// SPDX-License-Identifier: Apache-2.0
// Annotations and tracks: what is read of their JSON, and what is refused by its place.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { readFileSync } from 'node:fs';
import { parseNotes, readNotes } from '../../viewer/notes.js';
import { blendedPose } from '../../viewer/view.js';

const view = { azimuth: 30, zoom: 2, target: [0, 1, 2] };
const sound = {
  version: 1,
  annotations: [{ at: [1, 2, 3], title: 'Rim', text: '<b>bent</b>', view }, { at: [0, 0, 0], title: 'Foot' }],
  tracks: [{ name: 'Tour', loop: true, stops: [{ view, annotation: 1 }, { view: {}, seconds: 0, pause: 5 }] }],
};

/** `sound` with another value at a place: ['annotations', 0, 'at']. */
function changed(path, value) {
  const root = structuredClone(sound);
  const inner = path.slice(0, -1).reduce((from, name) => from[name], root);
  if (value === undefined) delete inner[path.at(-1)];
  else inner[path.at(-1)] = value;
  return root;
}

test('notes are read with their defaults, and texts stay as they are', () => {
  const { annotations, tracks } = readNotes(sound);
  assert.deepEqual(annotations[0], { at: [1, 2, 3], title: 'Rim', text: '<b>bent</b>', view });
  assert.deepEqual(annotations[1], { at: [0, 0, 0], title: 'Foot', text: '', view: null });
  assert.deepEqual(tracks[0].stops[0], { view, seconds: 2, pause: 1, annotation: 1 });
  assert.deepEqual(readNotes({ version: 1 }), { annotations: [], tracks: [] });
});

for (const [path, value, place] of [
  [['version'], 2, 'version'],
  [['annotations'], {}, 'annotations'],
  [['annotations'], Array(201).fill(sound.annotations[0]), 'annotations'],
  [['annotations', 0], null, 'annotations[0]'],
  [['annotations', 0, 'at'], [1, 2], 'annotations[0].at'],
  [['annotations', 1, 'at'], [1, 2, '3'], 'annotations[1].at'],
  [['annotations', 1, 'title'], undefined, 'annotations[1].title'],
  [['annotations', 1, 'text'], 'x'.repeat(4001), 'annotations[1].text'],
  [['annotations', 0, 'view'], 'front', 'annotations[0].view'],
  [['annotations', 0, 'view', 'zoom'], 0, 'annotations[0].view.zoom'],
  [['tracks', 0, 'name'], 7, 'tracks[0].name'],
  [['tracks', 0, 'loop'], 'yes', 'tracks[0].loop'],
  [['tracks', 0, 'stops'], [], 'tracks[0].stops'],
  [['tracks', 0, 'stops', 0, 'annotation'], 2, 'tracks[0].stops[0].annotation'],
  [['tracks', 0, 'stops', 0, 'annotation'], 'constructor', 'tracks[0].stops[0].annotation'],
  [['tracks', 0, 'stops', 1, 'seconds'], -1, 'tracks[0].stops[1].seconds'],
  [['tracks', 0, 'stops', 1, 'view'], undefined, 'tracks[0].stops[1].view'],
  [['tracks', 0, 'stops', 1, 'view', 'target'], [0, 0, null], 'tracks[0].stops[1].view.target'],
])
  test(`${place} is refused by its name (${JSON.stringify(value)?.slice(0, 30)})`, () => {
    assert.throws(() => readNotes(changed(path, value)), (error) => error.kind === 'damaged' && error.detail.startsWith(`${place} `));
  });

test('what is no object at all is refused', () => {
  for (const root of [null, [], 7, 'x', undefined]) assert.throws(() => readNotes(root), { kind: 'damaged' });
});

test('what was read may be read again, and a text that is no JSON is refused', () => {
  const notes = readNotes(sound);
  assert.deepEqual(readNotes({ version: 1, ...notes }), notes, 'as the editor keeps them');
  assert.deepEqual(parseNotes(JSON.stringify(sound)), notes);
  for (const text of ['', '{', '{"version": 1', 'x'.repeat(2 ** 20 + 1)]) assert.throws(() => parseNotes(text), { kind: 'damaged' });
});

test('names that every object has are no entries', () => {
  assert.deepEqual(readNotes(JSON.parse('{"version": 1, "__proto__": {"annotations": 7}}')), { annotations: [], tracks: [] });
});

test('the example of the documentation is sound', () => {
  const text = readFileSync(new URL('../../../docs/notes.md', import.meta.url), 'utf8');
  const { annotations, tracks } = readNotes(JSON.parse(/```json\n([\s\S]*?)```/.exec(text)[1]));
  assert.equal(annotations.length, 2);
  assert.equal(tracks[0].stops.length, 2);
});

test('poses blend the short way round, and distances by their ratio', () => {
  const pose = (azimuth, distance) => ({ azimuth, distance, elevation: 0, fov: 30, target: [0, 0, 0] });
  const half = blendedPose(pose(170, 1), pose(-170, 4), 0.5);
  assert.deepEqual([half.azimuth, half.distance], [180, 2]);
  assert.equal(blendedPose(pose(-170, 1), pose(170, 1), 1).azimuth, -190);
  assert.equal(blendedPose(pose(-350, 1), pose(350, 1), 1).azimuth, -370);
});
