// SPDX-License-Identifier: Apache-2.0
// Frames of a light field that moves, from bytes that are pushed as they come. slf_frame_stream.js fetches them.
import { SlfError } from './slf_error.js';
import { SlfField } from './slf_field.js';
import { bytesOf, readInfo, setOptions } from './slf_headers.js';

const CHUNK_BYTES = 1 << 22; // of what is copied into the instance at a time

function invalid(what) { return new SlfError('INVALID_ARGUMENT', `INVALID_ARGUMENT: ${what}`); }

/** In an instance of its own, until release(). Fields that it gives share it. */
export class SlfFrames {
  #instance; #frames; #done; #list = []; #info = { place: -1, value: null };

  /** Use SlfDecoder.frames(). */
  constructor(instance, options, done) {
    this.#instance = instance;
    this.#done = done;
    this.ended = false;
    instance.call((w) => {
      setOptions(instance, options);
      this.#frames = w.slfw_frames_open();
      if (this.#frames === 0) instance.fail();
    });
  }

  /** [{place, number, time, predicted, lost, offset, bytes}] of the frames that have arrived whole. */
  get list() { return this.#list; }

  /** Memory that bytes of the stream take. */
  get heldBytes() { return this.#call((w) => w.slfw_frames_held(this.#frames)); }

  push(bytes) {
    const source = bytesOf(bytes);
    for (let at = 0; at < source.byteLength; at += CHUNK_BYTES)
      this.#call((w, instance) => {
        const piece = source.subarray(at, at + CHUNK_BYTES);
        if (w.slfw_frames_push(this.#frames, instance.put(piece), piece.byteLength) !== 0) instance.fail();
      });
    this.#update();
  }

  /** No bytes follow. */
  finish() {
    this.#call((w, instance) => { if (w.slfw_frames_finish(this.#frames) !== 0) instance.fail(); });
    this.ended = true;
    this.#update();
  }

  /** Whether the bytes of a frame are here. */
  holds(place) { return place < this.#list.length && this.#about(place).held; }

  /** The frame that the group of `place` begins with. */
  groupOf(place) {
    while (this.#list[place].predicted && !this.#list[place].lost) --place;
    return place;
  }

  /** Headers of the group of a frame, as SlfDecoder.info has them. */
  info(place = 0) {
    const first = this.groupOf(this.#known(place));
    if (this.#info.place === first) return this.#info.value;
    const value = this.#call((w, instance) => {
      const stream = w.slfw_frame_headers(this.#frames, first);
      if (stream === 0) instance.fail();
      try {
        return readInfo(instance, stream);
      } finally {
        w.slfw_release_stream(stream);
      }
    });
    this.#info = { place: first, value };
    return value;
  }

  /** @returns {SlfField} whose release() leaves the frames as they are */
  decode(place) {
    this.#known(place);
    const field = this.#call((w, instance) => w.slfw_frame_decode(this.#frames, place) || instance.fail());
    return new SlfField(this.#instance, field, this.info(place), () => {});
  }

  /** Drops the bytes of groups before that of a frame. */
  dropBefore(place) {
    this.#known(place);
    this.#call((w) => w.slfw_frames_drop_before(this.#frames, place));
  }

  /** The bytes pushed next are those from this frame on, which is not predicted; what is held is dropped. */
  seek(place) {
    this.#known(place);
    this.#call((w, instance) => { if (w.slfw_frames_seek(this.#frames, place) !== 0) instance.fail(); });
    this.ended = false;
  }

  release() {
    if (this.#instance === null) return;
    if (!this.#instance.dead) this.#instance.wasm.slfw_frames_release(this.#frames);
    this.#done(this.#instance);
    this.#instance = null;
  }

  #known(place) {
    if (!Number.isInteger(place) || place < 0 || place >= this.#list.length)
      throw invalid(`place must be a whole number below ${this.#list.length}`);
    return place;
  }

  #update() {
    const count = this.#call((w) => w.slfw_frames_count(this.#frames));
    for (let place = this.#list.length; place < count; ++place) this.#list.push(this.#about(place).frame);
  }

  #about(place) {
    return this.#call((w, instance) => {
      if (w.slfw_frame(this.#frames, place) !== 0) instance.fail();
      const [number, time, offset, bytes, predicted, lost, held] = instance.numbers(7);
      const frame = { place, number, time, predicted: predicted !== 0, lost: lost !== 0, offset, bytes };
      return { frame, held: held !== 0 };
    });
  }

  /** body(w, instance) */
  #call(body) {
    const instance = this.#instance;
    if (instance === null) throw invalid('the frames were released');
    return instance.call((w) => body(w, instance));
  }
}
