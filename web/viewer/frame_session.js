// SPDX-License-Identifier: Apache-2.0
// What a decoding worker does with a light field that moves: it reads the file by itself, in parts, and packs frames.
import { SlfFrameStream } from '../slf_frame_stream.js';
import { checkColours, plainInfo } from './decode_session.js';
import { packField } from './packed_field.js';
import { FrameFunctions } from './packed_functions.js';
import { partOf, partWithin } from './part.js';

export class FrameSession {
  #load; #tell; #stream = null; #told = 0; #ended = false; #tableSize = 65; #shared = new FrameFunctions();

  /**
   * @param {() => Promise<object>} load  a decoder of slf.js
   * @param {(list: {frames: object[], ended: boolean, bytes: number}) => void} tell  frames that have arrived since
   */
  constructor(load, tell) {
    this.#load = load;
    this.#tell = tell;
  }

  /**
   * Opens in place of what was open before; reading goes on as far as memory is allowed.
   * @param {object} options  source: address, Blob or bytes; levels, groups, layers, tableSize: as of
   *   DecodeSession.decode(); budget: of part.js; keepBytes of the file; headers, credentials, stallMs: of fetch
   * @returns {{info: object, coarser?: object}}  as of DecodeSession.decode(), by the first frame
   */
  async open({ source, levels = 0, groups = 0, layers = 0, budget = {}, tableSize = 65, ...request }) {
    const decoder = await this.#load();
    await this.close();
    const stream = await SlfFrameStream.open(source, { ...request, decoder });
    const info = plainInfo(stream.info()),
      asked = partOf(info, { levels, groups, layers }); // how many there are is known now
    checkColours(info);
    const { maxMemory = 2 ** 31 } = budget,
      part = partWithin(info, asked, { ...budget, maxMemory }, (one) => stream.preflight(0, one));
    stream.setOptions({ ...part, maxMemory });
    this.#stream = stream;
    this.#told = 0;
    this.#ended = false;
    this.#tableSize = tableSize;
    this.#shared = new FrameFunctions();
    this.#say();
    this.#readAhead(stream);
    return { info, coarser: part === asked ? undefined : part };
  }

  /** @returns {{packed?: object, info?: object, seconds?: number}} without `packed` where the file ends before it */
  async decode(place) {
    const stream = this.#stream;
    if (!(await stream.arrive(place))) return {};
    if (stream === this.#stream) this.#say(); // else it was closed meanwhile, and the decode says so
    const begin = performance.now(),
      field = await stream.decode(place);
    try {
      let group = place;
      while (stream.list[group].predicted) --group;
      this.#shared.begin(group);
      checkColours(field.info);
      const packed = packField(field, this.#tableSize, false, this.#shared);
      return { packed, info: plainInfo(field.info), seconds: (performance.now() - begin) / 1000 };
    } finally {
      field.release();
    }
  }

  /** Frees the memory of what is open. */
  async close() {
    const stream = this.#stream;
    this.#stream = null;
    await stream?.close();
  }

  /** What stops it is met, and said, by the decode that needs it. */
  async #readAhead(stream) {
    try {
      while (stream === this.#stream && (await stream.readAhead())) this.#say();
    } catch {
      return;
    }
    if (stream === this.#stream) this.#say();
  }

  #say() {
    const { list, ended } = this.#stream,
      last = list[list.length - 1];
    if (list.length === this.#told && ended === this.#ended) return;
    this.#ended = ended;
    this.#tell({ frames: list.slice(this.#told), ended, bytes: last.offset + last.bytes });
    this.#told = list.length;
  }
}
