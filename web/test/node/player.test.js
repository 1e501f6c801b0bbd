// SPDX-License-Identifier: Apache-2.0
// When which frame shows: a player with a clock and a decoder of the test's own.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { FramePlayer } from '../../viewer/player.js';

const RATE = 30, GROUP = 8;
const settled = () => new Promise((done) => setTimeout(done));

/** Frames in groups of eight; `damaged` cannot be decoded, nor what follows in their group. */
function sourceOf(count, { damaged = [], seconds = 0.001, ended = true } = {}) {
  const list = Array.from({ length: count }, (_, place) => ({ place, number: place, time: 5 + place / RATE, predicted: place % GROUP > 0, lost: false }));
  const source = {
    list, ended, asked: [], held: [],
    groupOf: (place) => place - (place % GROUP),
    async decode(place) {
      source.asked.push(place);
      if (source.hold) await new Promise((go) => source.held.push(go));
      const bad = damaged.find((each) => each <= place && source.groupOf(each) === source.groupOf(place));
      if (bad !== undefined) throw Object.assign(new Error('damaged'), { kind: 'damaged' });
      return { packed: { places: new Float32Array(8) }, info: {}, seconds };
    },
  };
  return source;
}

function playerOf(source, options) {
  const told = { shown: [], failed: [], stopped: [], finished: 0 };
  const player = new FramePlayer(source, {
    show: (_, frame) => told.shown.push(frame.place),
    failed: (_, frame) => told.failed.push(frame.place),
    stopped: (error) => told.stopped.push(error.kind),
    finished: () => ++told.finished,
  }, options);
  player.begin(0);
  return { player, told };
}

/** Ticks of the clock, with time for what was asked for in between. */
async function run(player, seconds, tick = 1 / 60) {
  for (let at = 0; at < seconds - 1e-9; at += tick) {
    player.tick(tick);
    await settled();
  }
}

test('every frame shows once, in order and in its time, where decoding is quick', async () => {
  const source = sourceOf(20), { player, told } = playerOf(source, { loop: false });
  player.play();
  await run(player, 10.5 / RATE);
  assert.deepEqual(told.shown, [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]);
  await run(player, 1);
  assert.deepEqual(told.shown, Array.from({ length: 19 }, (_, i) => i + 1));
  assert.deepEqual([told.finished, player.playing, player.dropped, player.frame], [1, false, 0, 19]);
  assert.ok(Math.abs(player.duration - 20 / RATE) < 1e-9);
  player.play(); // from the beginning
  await run(player, 2.5 / RATE);
  assert.deepEqual(told.shown.slice(19, 22), [0, 1, 2]);
});

test('no more than a few frames are decoded ahead, and none while it stands', async () => {
  const source = sourceOf(100), { player } = playerOf(source);
  await run(player, 1);
  assert.equal(source.asked.length, 0);
  player.play();
  for (let i = 0; i < 20; ++i) await settled();
  assert.ok(source.asked.length >= 3 && source.asked.length <= 5, `${source.asked.length}`);
  player.pause();
  await run(player, 1);
  assert.ok(source.asked.length <= 5);
});

test('a loop goes on at the first frame, at twice the speed too', async () => {
  const source = sourceOf(6), { player, told } = playerOf(source, { speed: 2 });
  player.play();
  await run(player, 9.5 / RATE / 2, 1 / 240);
  assert.deepEqual(told.shown, [1, 2, 3, 4, 5, 0, 1, 2, 3]);
  player.setLoop(false);
  await run(player, 1);
  assert.deepEqual(told.shown.slice(9), [4, 5]);
  assert.equal(told.finished, 1);
});

test('frames are left out rather than late where decoding is slow', async () => {
  for (const cost of [0.05, 0.1, 0.3]) { // a frame lasts 0.033
    const source = sourceOf(240, { seconds: 0 }), late = [];
    let now = 0;
    const waits = [];
    const decode = source.decode;
    let at = 0; // as FrameReader: from where it is, or from the group's beginning
    source.decode = async (place) => {
      const group = source.groupOf(place), frames = at >= group && at < place ? place - at : place - group + 1;
      at = place;
      const until = now + frames * cost;
      await new Promise((go) => waits.push({ until, go }));
      return { ...(await decode(place)), seconds: frames * cost };
    };
    const { player, told } = playerOf(source, { loop: false });
    player.on.show = (_, frame) => {
      told.shown.push(frame.place);
      late.push(now - frame.place / RATE);
    };
    player.play();
    for (; now < 6; now += 1 / 60) {
      for (const wait of waits.splice(0)) wait.until <= now ? wait.go() : waits.push(wait);
      await settled();
      player.tick(1 / 60);
      await settled();
    }
    const behind = late.slice(Math.ceil(late.length / 3)); // the first have taught it what a frame costs
    assert.ok(told.shown.length >= 6, `${cost}: ${told.shown}`);
    assert.ok(told.shown.every((place, i) => i === 0 || place > told.shown[i - 1]));
    assert.ok(behind.every((seconds) => seconds < 0.1 + cost), `${cost}: ${behind}`);
    assert.ok(player.dropped > 0.8 * (6 * RATE - 6 / cost), `${cost}: ${player.dropped}`); // all but what can be decoded
  }
});

test('the end shows the last frame, however late, before it is told', async () => {
  for (const damaged of [[], [19]]) {
    const source = sourceOf(20, { seconds: 0.5, damaged }), { player, told } = playerOf(source, { loop: false });
    player.play();
    await run(player, 5, 1 / 5);
    assert.deepEqual([told.finished, player.playing, told.stopped], [1, false, []]);
    assert.equal(told.shown.at(-1) === 19, !damaged.length);
    assert.ok(told.failed.length <= 1);
  }
});

test('a tick of several laps shows what is of its time, and goes on', async () => {
  const source = sourceOf(12), { player, told } = playerOf(source);
  player.play();
  for (let i = 0; i < 12; ++i) {
    player.tick(0.93);
    await settled();
    await settled();
  }
  assert.ok(new Set(told.shown).size >= 4, `${told.shown}`);
  assert.equal(player.playing, true);
});

test('of a short loop that decodes slowly all groups are seen', async () => {
  const source = sourceOf(24, { seconds: 0.9 }), { player, told } = playerOf(source); // longer than the loop
  player.play();
  await run(player, 30, 0.23);
  assert.deepEqual([...new Set(told.shown)].filter((place) => place % GROUP === 0).sort((a, b) => a - b), [0, 8, 16]);
});

test('a jump shows its frame as soon as it is decoded, and a later jump comes before it', async () => {
  const source = sourceOf(50), { player, told } = playerOf(source);
  source.hold = true;
  player.seek(30);
  player.seek(41);
  player.seek(12.4);
  assert.deepEqual(source.asked, [30]);
  assert.equal(player.frame, 12);
  source.held.shift()();
  await settled();
  assert.deepEqual(source.asked, [30, 12]); // 41 was passed by
  source.held.shift()();
  await settled();
  assert.deepEqual([told.shown.at(-1), player.shown, player.frame], [12, 12, 12]);
  player.step(1);
  assert.equal(player.frame, 13);
  player.seek(1e9);
  assert.equal(player.frame, 49);
  player.seek(NaN);
  player.seek(-3);
  assert.equal(player.frame, 0);
});

test('a damaged frame is said once, its group passed over, and playing goes on', async () => {
  const source = sourceOf(24, { damaged: [10] }), { player, told } = playerOf(source, { loop: false });
  player.play();
  await run(player, 1);
  assert.deepEqual(told.failed, [10]);
  assert.deepEqual(told.shown, [...Array.from({ length: 9 }, (_, i) => i + 1), 16, 17, 18, 19, 20, 21, 22, 23]);
  assert.equal(told.finished, 1);
});

test('a file that is damaged everywhere does not keep the decoder busy', async () => {
  const source = sourceOf(24, { damaged: [0, 8, 16] }), { player, told } = playerOf(source);
  player.play();
  await run(player, 3);
  assert.deepEqual(told.failed.sort((a, b) => a - b), [0, 1, 8, 16]); // 0 showed already, and comes again
  assert.ok(source.asked.length < 10, `${source.asked}`);
});

test('what ends the decoder stops the player', async () => {
  const source = sourceOf(24), { player, told } = playerOf(source);
  source.decode = async () => { throw Object.assign(new Error('gone'), { kind: 'memory' }); };
  player.play();
  await run(player, 0.2);
  assert.deepEqual([told.stopped, player.playing], [['memory'], false]);
});

test('the clock waits for frames that are on their way', async () => {
  const source = sourceOf(4, { ended: false }), { player, told } = playerOf(source);
  player.play();
  await run(player, 1);
  assert.deepEqual(told.shown, [1, 2, 3]);
  const more = sourceOf(10).list.slice(4);
  source.list.push(...more);
  source.ended = true;
  player.arrived();
  await run(player, 2.5 / RATE);
  assert.deepEqual(told.shown.slice(3), [4, 5]);
});

test('the end of a jump is told once: its frame shows, is damaged, or is not there', async () => {
  const source = sourceOf(24, { damaged: [10] }), { player } = playerOf(source), told = [];
  player.on.sought = (error, there) => told.push([error?.kind ?? null, there]);
  player.seek(3);
  player.seek(5);
  for (let i = 0; i < 4; ++i) await settled();
  assert.deepEqual([told, player.shown], [[[null, true]], 5]);
  player.seek(12);
  for (let i = 0; i < 4; ++i) await settled();
  const { decode } = source;
  source.decode = async () => null;
  player.seek(2);
  for (let i = 0; i < 4; ++i) await settled();
  source.decode = decode;
  player.play();
  await run(player, 0.2); // what plays is no jump
  assert.deepEqual(told, [[null, true], ['damaged', false], [null, false]]);
});
