// SPDX-License-Identifier: Apache-2.0
// A light field that moves, as an object of three.js, without a picture: its clock, jumps, damage, its end; what follows
// the frame that shows.
import assert from 'node:assert/strict';
import { existsSync } from 'node:fs';
import { test } from 'node:test';
import { SlfDecoder } from '../../slf_node.js';
import { packField } from '../../viewer/packed_field.js';
import { normalOf, placeOf, shiftOf } from '../../viewer/packed_texels.js';
import { aborted } from '../../viewer/source_stream.js';
import { caseOf } from './support.js';

const skip = !existsSync(new URL('../../node_modules/three', import.meta.url)) && 'there is no three: npm ci in web/';
const { Box3, Raycaster, Vector3 } = skip ? {} : await import('three');
const { SLFLoader } = skip ? {} : await import('../../viewer/SLFLoader.js');
const { SurfaceLightField } = skip ? {} : await import('../../viewer/surface_light_field.js');
const { LightFieldMotion } = await import('../../viewer/light_field_motion.js');

const FRAMES = 3, GROUP = 2, RATE = 4, DURATION = FRAMES / RATE, STEP = 1 / RATE;
const still = caseOf('harmonics').bytes;

/** One light field in three places: a frame is told from another by where it is. */
const whole = await (async () => {
  const field = (await SlfDecoder.create()).decode(still), first = packField(field);
  field.release();
  return Array.from({ length: FRAMES }, (_, place) => {
    const by = (at) => at.map((v) => v + 3 * place * first.radius);
    return { ...first, centre: by(first.centre), box: first.box.map(by) };
  });
})();

/** As FrameSource, without a worker; `damaged` cannot be decoded, nor what follows in its group. */
function sourceOf({ damaged = Infinity } = {}) {
  const list = whole.map((_, place) => ({ place, number: 10 + place, time: 5 + place / RATE, predicted: place % GROUP > 0, lost: false }));
  const source = { list, ended: true, over: false, groupOf: (place) => place - (place % GROUP) };
  source.decode = async (place) => {
    await new Promise((done) => setTimeout(done));
    if (source.over) throw aborted();
    if (place >= damaged && source.groupOf(place) === source.groupOf(damaged)) throw Object.assign(new Error('damaged'), { kind: 'damaged' });
    return { packed: whole[place], info: { place }, seconds: 0.001 };
  };
  return source;
}

function loaded(options) {
  const source = sourceOf(options);
  return SurfaceLightField.moving({ packed: whole[0], info: { place: 0 } }, source, () => (source.over = true));
}

const shows = (field) => whole.indexOf(field.packed);
const turn = () => new Promise((done) => setTimeout(done, 2));

/** What a field tells, in order. */
function heard(field) {
  const told = [];
  for (const type of ['framechange', 'frameerror', 'ended', 'error'])
    field.addEventListener(type, ({ frame, number, time, error }) => told.push({ type, frame, number, time, kind: error?.kind }));
  return told;
}

/** The application's loop. */
async function run(field, seconds, step = 0.01) {
  for (let at = 0; at < seconds; at += step) {
    field.update(step);
    await turn();
  }
}

test('a file that moves shows its first frame, and knows of the others', { skip }, () => {
  const field = loaded();
  assert.deepEqual([field.frames, field.frame, field.time, field.paused, field.loop, field.speed], [FRAMES, 0, 0, true, true, 1]);
  assert.ok(Math.abs(field.duration - DURATION) < 1e-9);
  assert.equal(shows(field), 0);
  assert.deepEqual(field.info, { place: 0 });
  field.dispose();
});

test('a file of one frame stands still, whatever is asked of it', { skip }, async () => {
  const field = await new SLFLoader().parse(still), { packed } = field, told = heard(field);
  field.play();
  field.speed = 2;
  assert.deepEqual([field.update(1), field.frames, field.duration, field.time, field.paused, field.speed], [false, 0, 0, 0, true, 1]);
  assert.deepEqual([await field.setTime(3), await field.setFrame(0)], [0, 0]);
  assert.deepEqual([field.packed === packed, told], [true, []]);
  field.dispose();
});

test('the clock of the application moves it, and nothing moves without', { skip }, async () => {
  const field = loaded(), told = heard(field);
  assert.equal(field.update(0.5), false);
  field.play();
  for (let i = 0; i < 20; ++i) await turn();
  assert.deepEqual([field.frame, told], [0, []]);
  await run(field, 1.5 * DURATION);
  const places = told.map(({ type, frame }) => (type === 'framechange' ? frame : type));
  assert.deepEqual(places.slice(0, 3), [1, 2, 0]);
  field.pause();
  const at = field.frame;
  assert.equal(field.update(DURATION), false);
  await turn();
  assert.deepEqual([field.frame, shows(field)], [at, at]);
  field.dispose();
});

test('without a loop it ends at the last frame, and begins again', { skip }, async () => {
  const field = loaded(), told = heard(field);
  field.loop = false;
  field.play();
  await run(field, 2 * DURATION);
  assert.deepEqual(told.map(({ type }) => type), ['framechange', 'framechange', 'ended']);
  assert.deepEqual([field.paused, shows(field)], [true, FRAMES - 1]);
  field.play();
  await run(field, 0.02);
  assert.equal(told.at(-1).frame, 0);
  field.dispose();
});

test('a jump gives its frame, there and back, by time and by place', { skip }, async () => {
  const field = loaded();
  for (const place of [2, 0, 1, 0, 2]) {
    assert.equal(await field.setFrame(place), place);
    assert.deepEqual([shows(field), field.frame], [place, place]);
    assert.deepEqual([field.time, field.info], [place / RATE, { place }]);
  }
  assert.equal(await field.setTime(1.5 * STEP), 1);
  assert.equal(shows(field), 1);
  assert.equal(await field.setTime(0.99 * STEP), 0);
  assert.equal(await field.setTime(STEP - 1e-9), 1); // what a computed time is short of
  assert.equal(await field.setTime(-0.5 * STEP), FRAMES - 1); // of the lap before
  assert.equal(await field.setTime(7 * DURATION + 1.2 * STEP), 1);
  field.loop = false;
  assert.equal(await field.setTime(7 * DURATION), FRAMES - 1);
  assert.equal(await field.setTime(-1), 0);
  field.dispose();
});

test('jumps that nobody waits for end at the last, for all who asked', { skip }, async () => {
  const field = loaded();
  assert.deepEqual(await Promise.all([2, 1, 2, 0, 1].map((place) => field.setFrame(place))), [1, 1, 1, 1, 1]);
  assert.equal(shows(field), 1);
  field.dispose();
});

test('a frame that is not there, and seconds that are none, are refused by name', { skip }, async () => {
  const field = loaded();
  for (const place of [FRAMES, -1, 0.5, NaN, '1', undefined])
    assert.throws(() => field.setFrame(place), (error) => error instanceof RangeError && error.message.includes(`setFrame(${place}): ${FRAMES} frames`));
  for (const seconds of [NaN, Infinity, undefined]) assert.throws(() => field.setTime(seconds), RangeError);
  for (const seconds of [NaN, -1, Infinity, undefined]) assert.throws(() => field.update(seconds), RangeError);
  field.play();
  await run(field, 0.6 * DURATION);
  assert.ok(field.frame > 0, 'what was refused has not stopped the clock');
  field.dispose();
});

test('a damaged frame is told and refused, its group passed over, and others show', { skip }, async () => {
  const field = loaded({ damaged: 1 }), told = heard(field);
  await assert.rejects(field.setFrame(1), { kind: 'damaged' });
  assert.equal(field.frame, 1); // the clock stands there, the picture does not
  await field.setFrame(0);
  assert.deepEqual([field.frame, shows(field)], [0, 0]);
  field.setFrame(1); // nobody waits for it: an unhandled rejection would end this process
  for (let i = 0; i < 10; ++i) await turn();
  assert.equal(await field.setFrame(2), 2);
  assert.equal(shows(field), 2);
  assert.deepEqual(told.filter(({ type }) => type === 'frameerror').slice(0, 1).map(({ frame, number, kind }) => [frame, number, kind]),
    [[1, 11, 'damaged']]);
  field.dispose();
});

test('bounds and rays are those of the frame that shows', { skip }, async () => {
  const field = loaded(), boxes = [];
  for (const place of [0, 2, 0]) {
    await field.setFrame(place);
    field.updateMatrixWorld(true);
    const { box: [low, high], centre, middle, step } = whole[place], box = new Box3().setFromObject(field);
    const near = (a, b) => a.forEach((v, k) => assert.ok(Math.abs(v - b[k]) < 1e-5 * (1 + Math.abs(b[k])), `${a} ${b}`));
    near(box.min.toArray(), low);
    near(box.max.toArray(), high);
    near(new Box3().setFromObject(field, true).max.toArray(), high);
    near(field.geometry.boundingSphere.center.toArray(), centre);
    boxes.push(box);
    // From outside, along the normal of a disc whose core nothing hides: it is met where this frame has it.
    const normal = normalOf(whole[place], 7), shift = shiftOf(whole[place], 7),
      at = placeOf(whole[place], 7).map((v, k) => centre[k] + step * (v - middle[k] + shift * normal[k]));
    const ray = new Raycaster(new Vector3(...at), new Vector3(...normal.map((v) => -v)));
    ray.ray.origin.addScaledVector(ray.ray.direction, -1e-3 * STEP);
    const [met] = ray.intersectObject(field);
    assert.ok(met && met.distance < step, `frame ${place}`);
  }
  assert.ok(boxes[0].equals(boxes[2]));
  assert.ok(!boxes[0].equals(boxes[1]));
  field.dispose();
});

test('clones show one frame, and what decodes ends with the last of them', { skip }, async () => {
  const field = loaded(), clone = field.clone(), told = [heard(field), heard(clone)];
  assert.equal(clone.geometry, field.geometry);
  await clone.setFrame(2);
  await turn();
  assert.deepEqual([shows(field), shows(clone), field.frame], [2, 2, 2]);
  assert.deepEqual(told.map((each) => each.map(({ frame }) => frame)), [[2], [2]]);
  field.dispose();
  field.dispose();
  assert.equal(await clone.setFrame(1), 1);
  await turn();
  assert.deepEqual(told.map((each) => each.length), [1, 2]); // who is disposed of hears no more
  clone.dispose();
  await assert.rejects(clone.setFrame(0), { name: 'AbortError' });
});

test('dispose() while it decodes gives up what was asked for, and nothing shows or plays after it', { skip }, async () => {
  const field = loaded(), other = loaded(), told = heard(field);
  field.play();
  const asked = field.setFrame(2);
  field.dispose();
  await assert.rejects(asked, { name: 'AbortError' });
  field.play();
  for (let i = 0; i < 20; ++i) {
    assert.equal(field.update(0.1), false);
    await turn();
  }
  assert.deepEqual([shows(field), field.paused, told], [0, true, []]);
  const { source } = other.shared.motion, late = other.setFrame(2); // whose decoder answers all the same, as one on this thread
  other.dispose();
  source.over = false;
  await assert.rejects(late, { name: 'AbortError' });
  for (let i = 0; i < 10; ++i) await turn();
  assert.equal(shows(other), 0);
});

test('what stops the decoder is told, and ends the jump', { skip }, async () => {
  const list = [0, 1].map((place) => ({ place, number: place, time: place / 10, predicted: false, lost: false }));
  const gone = Object.assign(new Error('gone'), { kind: 'memory' });
  const source = { list, ended: true, groupOf: (place) => place, decode: () => Promise.reject(gone) };
  const field = SurfaceLightField.moving({ packed: whole[0], info: {} }, source, () => {}), told = heard(field);
  await assert.rejects(field.setFrame(1), { kind: 'memory' });
  await turn();
  assert.deepEqual(told.map(({ type, kind }) => [type, kind]), [['error', 'memory']]);
  source.decode = async () => null; // the file has become shorter
  await assert.rejects(field.setFrame(0).then(() => field.setFrame(1)), { kind: 'damaged' });
});

test('frames ahead are a few, however long the file is', async () => {
  let asked = 0;
  const list = Array.from({ length: 500 }, (_, place) => ({ place, number: place, time: place / 30, predicted: false, lost: false }));
  const source = { list, ended: true, groupOf: (place) => place,
    decode: async () => (++asked, { packed: { places: new Float32Array(8) }, info: {}, seconds: 0 }) };
  const motion = new LightFieldMotion(source, () => {}, () => {});
  motion.play();
  for (let i = 0; i < 50; ++i) await turn();
  assert.ok(asked >= 3 && asked <= 5, `${asked}`);
  motion.dispose();
});
