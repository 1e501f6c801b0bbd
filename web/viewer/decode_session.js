// SPDX-License-Identifier: Apache-2.0
// What a decoding worker does; apart from it so that a page without workers can do it as well.
import { buffersOf, packField, ViewerError } from './packed_field.js';
import { partOf, partWithin } from './part.js';

/**
 * Lets `port` (a worker's scope, or one end of a MessageChannel) hold a file and decode it.
 * @param Frames  FrameSession, where files that move are decoded frame by frame
 */
export function answer(port, create, Frames = null) {
  const session = new DecodeSession(create);
  const frames = Frames && new Frames(() => session.loadDecoder(), (list) => port.postMessage({ list }));
  const reply = async (id, task) => {
    try {
      const result = await task;
      port.postMessage({ id, ...result }, result.packed ? buffersOf(result.packed) : result.bytes ? [result.bytes.buffer] : []);
    } catch (error) {
      port.postMessage({ id, error: plainError(error), info: session.info });
    }
  };
  port.onmessage = ({ data }) => {
    if (data.wasm) session.wasm = data.wasm;
    if (data.reset) session.reset();
    if (data.append) session.append(data.append);
    if (data.give) reply(data.id, session.give());
    if (data.decode) reply(data.id, session.decode(data.decode));
    if (data.frames) reply(data.id, frames.open(data.frames));
    if (data.frame !== undefined) reply(data.id, frames.decode(data.frame));
  };
}

export class DecodeSession {
  /** @param {(wasm?: WebAssembly.Module) => Promise<object>} create  a decoder of slf.js */
  constructor(create) {
    this.create = create;
    this.reset();
  }

  reset() {
    this.bytes = new Uint8Array(1 << 16);
    this.length = 0;
    this.info = undefined; // what the headers say, as soon as they could be read
    this.reader?.release();
    this.reader = null; // SlfFrames that has `read` of the bytes
    this.read = 0;
  }

  append(chunk) {
    if (this.length + chunk.length > this.bytes.length) {
      const larger = new Uint8Array(Math.max(2 * this.bytes.length, this.length + chunk.length));
      larger.set(this.bytes.subarray(0, this.length));
      this.bytes = larger;
    }
    this.bytes.set(chunk, this.length);
    this.length += chunk.length;
  }

  /** The file, which is not here any more then. */
  give() {
    const bytes = this.bytes.subarray(0, this.length);
    this.reset();
    return { bytes };
  }

  /**
   * @param {object} options  prefix: what units of the first `prefix` bytes show, or of more that were read before; 0: the
   *   file is all here; levels, groups, layers: 0 is all, and so is more than there are; budget: of part.js; tableSize
   * @returns {{packed?: object, info?: object, coarser?: object}} without `packed` where a prefix shows nothing yet; coarser: the
   *   levels and groups that were decoded (0: all), where what was asked for is beyond the budget
   */
  async decode({ prefix = 0, levels = 0, groups = 0, layers = 0, budget = {}, tableSize = 65 }) {
    const reader = this.readerOf(await this.loadDecoder(), prefix || this.length);
    if (prefix && !reader.arriving) return {};
    if (!prefix && !reader.ended) reader.finish();
    const info = (this.info = plainInfo(reader.info())),
      asked = partOf(info, { levels, groups, layers });
    const { maxMemory = 2 ** 31 } = budget,
      part = partWithin(info, asked, { ...budget, maxMemory }, (one) => reader.preflight(0, one));
    checkColours(info);
    const field = this.run(reader, { ...part, maxMemory });
    try {
      if (prefix && !hasColours(field)) return {};
      const coarser = part === asked ? undefined : part;
      return { packed: packField(field, tableSize, prefix > 0), info, coarser };
    } finally {
      field.release();
    }
  }

  /** One that has read as much of the file, or more; where the memory of the one before failed, another. */
  readerOf(decoder, length) {
    if (this.reader?.dead ?? true) {
      this.reader = decoder.frames();
      this.read = 0;
    }
    if (this.read < length) this.reader.push(this.bytes.subarray(this.read, length));
    this.read = Math.max(this.read, length);
    return this.reader;
  }

  /** One that did not arrive is asked for again by the next decode. */
  async loadDecoder() {
    try {
      return await (this.decoder ??= this.create(this.wasm));
    } catch (error) {
      this.decoder = undefined;
      throw error;
    }
  }

  /** A decoder whose memory failed is not asked again. */
  run(reader, options) {
    try {
      reader.setOptions(options);
      return reader.decode(0);
    } catch (error) {
      if (error instanceof WebAssembly.RuntimeError || error instanceof RangeError) this.decoder = undefined;
      throw error;
    }
  }
}

export function checkColours(info) {
  if (info.hasBasis === false)
    throw new ViewerError('no-view-maps', 'This file has no view maps: its planes have no colour.');
}

/** Not where coefficients are still to come: all points are alike then. */
function hasColours(field) {
  const means = field.meanColours();
  return means.some((value, i) => value !== means[i % 3]);
}

/** That can be posted. */
export const plainInfo = (info) => JSON.parse(JSON.stringify(info));

const WORDS = {
  TRUNCATED: 'It ends before it should: perhaps it was not copied whole.',
  CHECKSUM: 'Some of its bytes have changed since it was written.',
  NOT_SLF: 'It is not an .slf file.',
  UNSUPPORTED: 'It was made for another version or profile of the decoder.',
  LIMIT_EXCEEDED: 'Decoding it takes more than this page allows.',
  OUT_OF_MEMORY: 'There is not enough memory to decode it.',
  NETWORK: 'The decoder, a part of this page, did not arrive.',
  POLICY: 'The rules of this page (Content-Security-Policy) forbid the decoder.',
};
const KINDS = { OUT_OF_MEMORY: 'memory', LIMIT_EXCEEDED: 'too-large', UNSUPPORTED: 'unsupported', NETWORK: 'network', POLICY: 'policy' };

const OF_DECODER = ['wasm', 'locateFile']; // arguments that say where it is: it is missing then, and no file is damaged

const own = (table, name) => (Object.hasOwn(table, name) ? table[name] : undefined);

/** An error as a message can carry it: what a ViewerError is made of. */
export function plainError(error) {
  if (error instanceof ViewerError) return { kind: error.kind, words: error.words, detail: error.detail };
  if (error instanceof WebAssembly.RuntimeError || error instanceof RangeError)
    return { kind: 'memory', words: 'There is not enough memory to decode it.' };
  if (error?.code === 'INVALID_ARGUMENT' && OF_DECODER.includes(error.element))
    return { kind: 'network', words: WORDS.NETWORK, detail: error.message };
  const words = own(WORDS, error?.code) ?? 'Some of it says what cannot be.';
  return { kind: own(KINDS, error?.code) ?? 'damaged', words, detail: String(error?.message ?? error) };
}
