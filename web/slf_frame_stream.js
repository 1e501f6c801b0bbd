// SPDX-License-Identifier: Apache-2.0
// A light field that moves, from an address, a file or bytes, frame by frame.
//
//     for await (const frame of frames('walk.slf')) show(frame.time, frame.field);
import { SlfError, SlfDecoder } from './slf.js';
import { addressOf, bytesOf, checkDecoder, checkKeepBytes, checkedOptions, invalid } from './slf_arguments.js';
import { Request, requestOptions } from './slf_request.js';

const KEPT_BYTES = 2 ** 28; // of a stream, beyond which groups that are behind are dropped

/** Pieces of a source from an offset on. @param {boolean} own  the caller fetches them */
function piecesOf(source, request, own) {
  if (typeof source === 'string' || source instanceof URL) {
    const address = addressOf(source, 'source', own);
    return (offset) => new Request(request).pieces(address, offset);
  }
  if (typeof Blob === 'function' && source instanceof Blob) return (offset) => piecesOfStream(source.slice(offset).stream());
  const bytes = bytesOf(source, 'source', 'an address, a Blob, an ArrayBuffer or a view of one');
  return async function* whole(offset) { yield bytes.subarray(offset); };
}

async function* piecesOfStream(stream) {
  const reader = stream.getReader();
  try {
    for (;;) {
      const { done, value } = await reader.read();
      if (done) return;
      yield value;
    }
  } finally {
    reader.cancel().catch(() => {}); // whoever leaves early wants no more of it
  }
}

export class SlfFrameStream {
  #frames; #from; #pieces; #keep; #signal; #turn = Promise.resolve();
  #pending = null; // a promise of the piece that comes
  #coming = 0; // place of the frame that the pieces are about to bring

  /** Use SlfFrameStream.open(). */
  constructor(frames, from, keep, signal) {
    this.#frames = frames;
    this.#from = from;
    this.#keep = keep;
    this.#signal = signal;
    this.#pieces = from(0);
    this.received = 0; // bytes
  }

  /** Resolves when the first frame is here. */
  static async open(source, { decoder, wasm, signal, fetch: get, headers, credentials, stallMs, keepBytes = KEPT_BYTES,
    ...options } = {}) {
    const request = requestOptions({ signal, fetch: get, headers, credentials, stallMs });
    const from = piecesOf(source, request, Boolean(get));
    checkDecoder(decoder);
    checkKeepBytes(keepBytes);
    checkedOptions(options);
    decoder ??= await SlfDecoder.create({ wasm });
    const stream = new SlfFrameStream(decoder.frames(options), from, keepBytes, signal);
    try {
      await stream.arrive(0);
      return stream;
    } catch (error) {
      await stream.close();
      throw error;
    }
  }

  /** Frames that have arrived so far. */
  get list() { return this.#frames.list; }
  /** The list is complete. */
  get ended() { return this.#frames.ended; }
  get heldBytes() { return this.#frames.heldBytes; }
  /** Headers of the group of a frame that is here. */
  info(place = 0) { return this.#frames.info(place); }

  /** What a decode of a frame takes and gives with these options, which is here and not predicted. */
  preflight(place, options) { return this.#frames.preflight(place, options); }

  /** Levels, groups, limits of frames that are decoded from here on. */
  setOptions(options) { this.#frames.setOptions(options); }

  /** Reads until a frame is here, with its group. @returns {Promise<boolean>} false: the stream ends before it */
  arrive(place) { return this.#inTurn(() => this.#arrive(place)); }

  /** @returns {Promise<SlfField>} to be released */
  decode(place) {
    return this.#inTurn(async () => {
      if (!(await this.#arrive(place)))
        throw invalid('place', `must be below ${this.list.length}: the stream ends there`);
      return this.#frames.decode(place);
    });
  }

  /**
   * Reads a piece of what comes, for frames that will be asked for.
   * @returns {Promise<boolean>} false: the list is complete, or as much is held as may be
   */
  async readAhead() {
    if (this.ended || this.heldBytes > this.#keep / 2) return false;
    const piece = this.#next();
    await piece.catch(() => {}); // said when it is taken; no decode waits meanwhile
    await this.#inTurn(async () => { if (piece === this.#pending) await this.#take(); });
    return true;
  }

  /** Frames from a place on. What is wrong with one is its `error`; its field lives until the next is asked for. */
  async *play(place = 0) {
    for (; await this.arrive(place); ++place) {
      let field = null, error = null;
      try {
        field = await this.decode(place);
      } catch (caught) {
        if (!(caught instanceof SlfError) || ['ABORTED', 'NETWORK'].includes(caught.code)) throw caught;
        error = caught;
      }
      try {
        yield { ...this.list[place], field, error };
      } finally {
        field?.release();
      }
    }
  }

  [Symbol.asyncIterator]() { return this.play(); }

  async close() {
    await this.#inTurn(() => this.#frames.release());
    this.#leave();
  }

  /** The download ends with the piece that is on its way. */
  #leave() {
    this.#pieces.return().catch(() => {});
    this.#pending = null;
  }

  async #arrive(place) {
    const frames = this.#frames;
    if (!Number.isInteger(place) || place < 0) throw invalid('place', 'must be a whole number, 0 or more');
    await this.#goBack(place);
    while (!(place < frames.list.length && (frames.list[place].lost || frames.holds(place)))) {
      if (frames.ended) return false;
      await this.#take();
      this.#drop(place);
    }
    this.#drop(place);
    return true;
  }

  /** The piece that comes. */
  #next() { return (this.#pending ??= this.#pieces.next()); }

  async #take() {
    const frames = this.#frames, known = () => this.#coming < frames.list.length;
    if (this.#signal?.aborted) throw new SlfError('ABORTED', 'ABORTED: by the caller', { cause: this.#signal.reason });
    const { done, value } = await this.#next();
    this.#pending = null; // one that failed stays: there is nothing behind it
    if (done) {
      frames.finish();
    } else {
      this.received += value.byteLength;
      frames.push(value);
    }
    while (known() && (frames.list[this.#coming].lost || frames.holds(this.#coming))) ++this.#coming;
  }

  /** To a group whose bytes were dropped: they come again. */
  async #goBack(place) {
    const frames = this.#frames;
    if (place >= frames.list.length) return;
    const first = frames.groupOf(place);
    if (frames.list[first].lost || frames.holds(first) || this.#comesSoon(first)) return;
    frames.seek(first);
    this.#leave();
    this.#pieces = this.#from(frames.list[first].offset);
    this.#coming = first;
  }

  /** Of a frame that is known: the pieces that are on their way bring it before long. */
  #comesSoon(place) {
    const { list } = this.#frames;
    return place >= this.#coming && list[place].offset - list[this.#coming].offset <= this.#keep / 4;
  }

  #drop(place) {
    const frames = this.#frames;
    if (frames.list.length > 0 && frames.heldBytes > this.#keep) frames.dropBefore(Math.min(place, frames.list.length - 1));
  }

  /** One after another: each finds the frames as the one before has left them. */
  #inTurn(task) {
    const turn = this.#turn.then(task);
    this.#turn = turn.catch(() => {});
    return turn;
  }
}

/** The frames of an address, a Blob or bytes, in order: SlfFrameStream.play() of one that is opened and closed here. */
export async function* frames(source, options) {
  const stream = await SlfFrameStream.open(source, options);
  try {
    yield* stream.play();
  } finally {
    await stream.close();
  }
}
