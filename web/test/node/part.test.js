// SPDX-License-Identifier: Apache-2.0
// How much of a file a device is given: what it says of itself, and what of a file keeps within that.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { SlfDecoder } from '../../slf_node.js';
import { DecodeSession } from '../../viewer/decode_session.js';
import { deviceFacts, isHandheld, memoryOfDevice } from '../../viewer/device.js';
import { readOptions } from '../../viewer/options.js';
import { partWithin } from '../../viewer/part.js';
import { caseOf } from './support.js';

const desk = { gibibytes: 0, mobile: false, coarse: false, across: 1080 };
const phone = { gibibytes: 0, mobile: true, coarse: true, across: 390 };
const tablet = { gibibytes: 0, mobile: false, coarse: true, across: 820 };

/** What decoding a part of four levels and five groups takes: bytes by groups, points by levels. */
const takes = ({ levels, groups }) => ({ points: 4 ** (levels || 6), memoryBytes: 4 ** (levels || 6) * (groups || 5) });
const info = { levels: 6, groups: 5 },
  all = { levels: 0, groups: 0, layers: 0 };
const within = (budget, asked = all) => partWithin(info, asked, { mayBeCoarser: true, ...budget }, takes);

test('a phone and a tablet are told from a desk and from a screen with fingers on a wall', () => {
  assert.deepEqual([desk, phone, tablet].map(isHandheld), [false, true, true]);
  assert.ok(isHandheld({ ...phone, coarse: false })); // with a mouse
  assert.ok(!isHandheld({ ...tablet, across: 2160 }));
  assert.ok(!isHandheld({ ...desk, across: 768 }));
});

test('a decode may take a quarter of what a device says that it has, on a phone an eighth', () => {
  const memory = (device) => [0, 0.25, 2, 4, 8, 32].map((gibibytes) => memoryOfDevice({ ...device, gibibytes }));
  assert.deepEqual(memory(desk), [2048, 128, 512, 1024, 2048, 2048]);
  assert.deepEqual(memory(phone), [384, 32, 256, 512, 512, 512]);
  assert.deepEqual(memory(tablet), memory(phone));
});

test('what a device says is asked of the browser, and one that says nothing is a desk', () => {
  const browser = {
    navigator: { deviceMemory: 4, userAgentData: { mobile: true } },
    screen: { width: 844, height: 390 },
    matchMedia: (query) => ({ matches: query === '(pointer: coarse)' }),
  };
  assert.deepEqual(deviceFacts(browser), { ...phone, gibibytes: 4 });
  assert.ok(!isHandheld(deviceFacts({})));
  assert.equal(memoryOfDevice(deviceFacts({ navigator: {} })), 2048);
});

test('an address says otherwise', () => {
  assert.equal(readOptions(new URLSearchParams('memory=300'), {}).memory, 300 * 2 ** 20);
  assert.equal(readOptions(new URLSearchParams('memory=300.3'), {}).memory, Math.floor(300.3 * 2 ** 20)); // whole bytes
  assert.equal(readOptions(new URLSearchParams('memory=1e9'), {}).memory, 3500 * 2 ** 20);
});

test('what takes too much memory is decoded with as many levels as there is memory for', () => {
  assert.equal(within({ maxMemory: 5 * 4 ** 6 }), all);
  assert.deepEqual(within({ maxMemory: 5 * 4 ** 6 - 1 }), { levels: 5, groups: 0, layers: 0 });
  assert.equal(within({ maxMemory: 5 * 4 ** 3 }).levels, 3);
  assert.equal(within({ maxMemory: 5 * 4 ** 3 }, { ...all, levels: 5 }).levels, 3);
  assert.throws(() => within({ maxMemory: 5 * 4 ** 3 - 1 }), { kind: 'too-large' });
  assert.throws(() => within({ maxMemory: 5 * 4 ** 6 - 1, mayBeCoarser: false }), { kind: 'too-large' });
});

test('on a phone functions go before points, all but those without which there is a mean colour alone', () => {
  const part = (maxMemory, asked) => within({ maxMemory, groupsFirst: true }, asked);
  assert.equal(part(5 * 4 ** 6), all);
  for (const groups of [4, 3, 2]) assert.deepEqual(part(groups * 4 ** 6), { levels: 6, groups, layers: 0 });
  assert.deepEqual(part(2 * 4 ** 6 - 1), { levels: 5, groups: 0, layers: 0 });
  assert.deepEqual(part(4 * 4 ** 5), { levels: 5, groups: 4, layers: 0 });
  assert.deepEqual(part(3 * 4 ** 6, { ...all, groups: 4 }), { levels: 6, groups: 3, layers: 0 });
  assert.deepEqual(part(4 ** 6, { ...all, groups: 1 }), { ...all, groups: 1 });
  assert.equal(part(4 ** 6 - 1, { ...all, groups: 1 }).levels, 5);
  assert.throws(() => part(2 * 4 ** 3 - 1), { kind: 'too-large' });
});

test('more points than textures hold are fewer levels; where they may not be, what draws says so', () => {
  const maxMemory = Infinity;
  assert.deepEqual(within({ maxMemory, maxPoints: 4 ** 5, groupsFirst: true }), { levels: 5, groups: 0, layers: 0 });
  assert.equal(within({ maxMemory, maxPoints: 4 ** 5, mayBeCoarser: false }), all);
  assert.equal(within({ maxMemory, maxPoints: 1 }), all);
});

test('a file is decoded with the groups that fit, and says which', async () => {
  const decoder = await SlfDecoder.create(),
    { bytes } = caseOf('harmonics');
  const session = new DecodeSession(async () => decoder);
  session.append(bytes);
  const whole = await session.decode({}),
    { memoryBytes: maxMemory } = session.reader.preflight(0, { groups: 2 });
  const decode = (budget) => session.decode({ budget: { maxMemory, mayBeCoarser: true, ...budget } });
  assert.equal(whole.coarser, undefined);
  const { packed, coarser } = await decode({ groupsFirst: true });
  assert.deepEqual(coarser, { levels: whole.info.levels, groups: 2, layers: 0 });
  assert.equal(packed.components, 4);
  await assert.rejects(decode({ groupsFirst: true, mayBeCoarser: false }), { kind: 'too-large' });
});
