// SPDX-License-Identifier: Apache-2.0
// The page's side of a light field that moves: what has arrived of it, and its frames from the worker.

export class FrameSource {
  #ask; #functions = null; // the functions that came last: frames that have the same bring none

  /** @param {(message: object) => Promise<object>} ask  the worker of decode_worker.js */
  constructor(ask) {
    this.#ask = ask;
    this.list = []; // of frames that have arrived, as SlfFrames.list
    this.ended = false; // the list is complete
    this.bytes = 0; // of the frames that have arrived
    this.coarser = undefined; // the part that is decoded, where that is not what was asked for
    this.changed = () => {}; // more have
  }

  /** @param {string|URL|Blob|ArrayBuffer|Uint8Array} source  @param {object} options  of FrameSession.open() */
  async open(source, options) {
    const from = typeof source === 'string' || source instanceof URL ? new URL(source, location.href).href : source;
    this.list = [];
    this.ended = false;
    const { info, coarser } = await this.#ask({ frames: { ...options, source: from } });
    this.coarser = coarser;
    return { info };
  }

  /** @returns {Promise<{packed, info, seconds}|null>} seconds: that it took; null: there is no such frame  @throws {ViewerError} */
  async decode(place) {
    const { packed, info, seconds } = await this.#ask({ frame: place });
    if (!packed) return null;
    if (packed.functions.texels) this.#functions = packed.functions;
    else packed.functions = this.#functions;
    return { packed, info, seconds };
  }

  /** What the worker says has arrived since it last said so. */
  take({ frames, ended, bytes }) {
    this.list.push(...frames);
    this.ended ||= ended;
    this.bytes = Math.max(this.bytes, bytes);
    this.changed();
  }

  /** The first frame of the group of a frame: decoding begins there. */
  groupOf(place) {
    while (this.list[place].predicted && !this.list[place].lost) --place;
    return place;
  }
}
