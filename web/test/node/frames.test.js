// SPDX-License-Identifier: Apache-2.0
// Frames of streams that move: the integers of the suite, from bytes in pieces, by ranges, in a worker.
import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { SlfDecoder, SlfError, SlfFrameStream, SlfFrames, frames } from '../../slf_node.js';
import { cases, digest, optionsOf, serve } from './support.js';

const decoder = await SlfDecoder.create();
const moving = cases('streams').filter((one) => /^frames-/.test(one.id));
const groups = moving.find((one) => one.id === 'frames-groups').bytes; // frames 0 and 1, then 2
const still = cases('streams').find((one) => one.id === 'basis').bytes;
const server = await serve({ groups });
after(() => server.close());

/** Pushed in pieces. */
function readerOf(bytes, options, piece = bytes.length) {
  const reader = decoder.frames(options);
  for (let at = 0; at < bytes.length; at += piece) reader.push(bytes.subarray(at, at + piece));
  reader.finish();
  return reader;
}

function digestsOf(field) {
  const digests = { positions: digest(field.positions), components: digest(Int32Array.from(field.values)) };
  field.release();
  return digests;
}

const expected = readerOf(groups);
const whole = expected.list.map(({ place }) => digestsOf(expected.decode(place)));

/** One byte changed. */
const damaged = (bytes, at) => bytes.map((b, i) => (i === at ? b ^ 4 : b));
const ofFrame = (place, at) => expected.list[place].offset + at;

test('the suite has streams that move', () => {
  assert.ok(moving.length >= 10);
  assert.ok(expected instanceof SlfFrames);
  assert.deepEqual(expected.list.map((f) => f.predicted), [false, true, false]);
});

for (const one of moving)
  test(`${one.id}: every frame is what the suite says, whatever the pieces`, () => {
    let checked = 0;
    for (const piece of [7, one.bytes.length])
      for (const asked of one.expect.filter((each) => !each.region)) {
        const reader = readerOf(one.bytes, optionsOf(asked), piece);
        const field = reader.decode(asked.frame ?? 0); // of one frame no entry names it
        assert.equal(field.points, asked.points);
        assert.equal(field.partial, asked.partial);
        const found = digestsOf(field);
        assert.equal(found.positions, asked.positions_sha256, `frame ${asked.frame}`);
        if (asked.components_sha256 && asked.components > 0) assert.equal(found.components, asked.components_sha256, `frame ${asked.frame}`);
        reader.release();
        ++checked;
      }
    assert.ok(checked > 0);
  });

test('a frame is there with its last byte and not before', () => {
  const reader = decoder.frames();
  for (let at = 0; at < groups.length; ++at) {
    assert.equal(reader.list.length, expected.list.filter((f) => f.offset + f.bytes <= at).length);
    reader.push(groups.subarray(at, at + 1));
  }
  assert.deepEqual(reader.list, expected.list);
  assert.equal(reader.heldBytes, groups.length);
  reader.release();
  assert.throws(() => reader.push(groups), { code: 'INVALID_ARGUMENT' });
  reader.release(); // twice does no harm
});

test('a light field that does not move is one frame', () => {
  const reader = readerOf(still), field = decoder.decode(still);
  assert.equal(reader.list.length, 1);
  assert.deepEqual(digestsOf(reader.decode(0)), digestsOf(field));
  assert.equal(reader.info().points, decoder.info(still).points);
});

test('a light field that does not move is decoded while it arrives: each time what decode() makes of its units', () => {
  for (const { id, bytes } of cases('streams').filter((one) => ['basis', 'scene-shared', 'layers-four', 'harmonics'].includes(one.id))) {
    const reader = decoder.frames();
    let shown = 0;
    for (let at = 0, before = 0; at < bytes.length - 1; ++at) {
      reader.push(bytes.subarray(at, at + 1));
      const end = reader.arriving?.bytes ?? 0;
      if (end === before) continue;
      assert.equal(end, at + 1, id); // with its last byte, and not before
      assert.equal(reader.info().complete, false);
      assert.equal(reader.info().decodeBytes, decoder.info(bytes.subarray(0, end)).decodeBytes);
      assert.equal(reader.preflight(0).memoryBytes, decoder.preflight(bytes.subarray(0, end)).memoryBytes);
      assert.deepEqual(digestsOf(reader.decode(0)), digestsOf(decoder.decode(bytes.subarray(0, end))), `${id} ${end}`);
      before = end;
      ++shown;
    }
    assert.ok(shown > 4);
    assert.deepEqual(reader.list, []);
    reader.push(bytes.subarray(bytes.length - 1));
    assert.equal(reader.arriving, null);
    assert.equal(reader.list.length, 1); // its end unit says that it is all here
    reader.finish();
    assert.deepEqual(digestsOf(reader.decode(0)), digestsOf(decoder.decode(bytes)));
    reader.release();
    assert.ok(reader.dead);
  }
});

test('damage of a light field that does not move is said when its unit has come', () => {
  const reader = decoder.frames(), at = still.length - 60;
  reader.push(still.subarray(0, at));
  assert.ok(reader.arriving);
  assert.throws(() => reader.push(damaged(still, at).subarray(at)), SlfError);
  assert.equal(reader.arriving, null);
  assert.throws(() => reader.decode(0), SlfError);
  assert.throws(() => reader.finish(), SlfError);
  reader.release();
});

test('other options are those of frames decoded from then on', () => {
  const reader = readerOf(groups), coarse = readerOf(groups, { levels: 3 });
  assert.deepEqual(digestsOf(reader.decode(1)), whole[1]);
  reader.setOptions({ levels: 3 });
  assert.deepEqual(digestsOf(reader.decode(1)), digestsOf(coarse.decode(1)));
  reader.setOptions();
  assert.deepEqual(digestsOf(reader.decode(2)), whole[2]);
});

test('places are checked, and what is no stream is refused for good', () => {
  for (const place of [-1, 3, 1.5, '0', undefined])
    assert.throws(() => expected.decode(place), { code: 'INVALID_ARGUMENT' });
  assert.throws(() => expected.seek(1), { code: 'INVALID_ARGUMENT' });
  const reader = decoder.frames();
  assert.throws(() => reader.push(Buffer.from('no light field')), { code: 'NOT_SLF' });
  assert.throws(() => reader.push(groups), { code: 'NOT_SLF' });
  reader.release();
});

test('frames come in order from bytes, a Blob and an address, with their times', async () => {
  for (const source of [groups, new Blob([groups]), server.url('groups'), new URL(server.url('groups'))]) {
    const found = [], fields = [];
    for await (const frame of frames(source, { decoder })) {
      assert.equal(frame.error, null);
      assert.equal(frame.time, expected.list[frame.place].time);
      found.push({ positions: digest(frame.field.positions), components: digest(Int32Array.from(frame.field.values)) });
      fields.push(frame.field);
    }
    assert.deepEqual(found, whole);
    assert.throws(() => fields[0].positions.length + fields[0].meanColours().length, { code: 'INVALID_ARGUMENT' }); // released
  }
});

test('whoever leaves early ends the download', async () => {
  for await (const frame of frames(server.url('groups'), { decoder })) {
    assert.equal(frame.place, 0);
    break;
  }
});

test('a damaged frame is said, and the next group goes on', async () => {
  for (const at of [ofFrame(1, 2), ofFrame(1, 60)]) { // of its frame unit; of a unit behind
    const said = [];
    for await (const { number, lost, error, field } of frames(damaged(groups, at), { decoder })) {
      said.push([number, lost, error?.code ?? null]);
      if (error) {
        assert.ok(error instanceof SlfError && error.element !== '');
        assert.equal(field, null);
        assert.ok(error.bitOffset >= 8 * ofFrame(1, 0) && error.bitOffset < 8 * ofFrame(2, 0));
      }
    }
    assert.deepEqual(said.map(([number, , code]) => [number, code !== null]), [[0, false], [1, true], [2, false]]);
    assert.equal(said[1][1], at === ofFrame(1, 2));
  }
});

test('groups that are behind are dropped, and come again by a range of the file', async () => {
  const stream = await SlfFrameStream.open(server.url('groups'), { decoder, keepBytes: 10 });
  const before = server.requests.length;
  assert.deepEqual(digestsOf(await stream.decode(2)), whole[2]);
  assert.ok(stream.heldBytes <= expected.list[2].bytes);
  assert.equal(server.requests.length, before);
  assert.deepEqual(digestsOf(await stream.decode(1)), whole[1]);
  assert.equal(server.requests.length, before + 1);
  assert.deepEqual(digestsOf(await stream.decode(0)), whole[0]);
  assert.equal(server.requests.length, before + 1);
  assert.deepEqual(digestsOf(await stream.decode(2)), whole[2]); // comes next
  assert.equal(server.requests.length, before + 1);
  assert.deepEqual(digestsOf(await stream.decode(0)), whole[0]);
  assert.ok(await stream.arrive(2));
  assert.ok(!(await stream.arrive(3)));
  await assert.rejects(stream.decode(3), { code: 'INVALID_ARGUMENT' });
  await stream.close();
});

test('a server without ranges gives the whole file again', async () => {
  const stream = await SlfFrameStream.open(server.url('groups', '?manner=whole'), { decoder, keepBytes: 10 });
  for (const place of [2, 0, 2, 1]) assert.deepEqual(digestsOf(await stream.decode(place)), whole[place]);
  await stream.close();
});

test('what a server does wrong is named', async () => {
  await assert.rejects(SlfFrameStream.open(server.url('none'), { decoder }), { code: 'NETWORK' });
  await assert.rejects(SlfFrameStream.open(groups.subarray(0, 40), { decoder }), { code: 'TRUNCATED' });
  const abort = new AbortController();
  abort.abort();
  await assert.rejects(SlfFrameStream.open(server.url('groups'), { decoder, signal: abort.signal }), { code: 'ABORTED' });
});
