// SPDX-License-Identifier: Apache-2.0
// Frames of a light field that moves, or one that does not, from bytes that are pushed as they come.
// slf_frame_stream.js fetches them.
import { bytesOf, checkedOptions, invalid, over } from './slf_arguments.js';
import { SlfField } from './slf_field.js';
import { preflight, readCost, setOptions } from './slf_headers.js';

const CHUNK_BYTES = 1 << 22; // of what is copied into the instance at a time

/** In an instance of its own, until release(). Fields that it gives share it. */
export class SlfFrames {
  #instance; #frames; #done; #list = []; #info = { place: -1, value: null };

  /** Use SlfDecoder.frames(). */
  constructor(instance, checked, done) {
    this.#instance = instance;
    this.#done = done;
    this.ended = false;
    instance.call((w) => {
      setOptions(instance, checked);
      this.#frames = w.slfw_frames_open();
      if (this.#frames === 0) instance.fail();
    });
  }

  /** Of frames that are decoded from here on. */
  setOptions(options) {
    const checked = checkedOptions(options);
    this.#call((w, instance) => {
      setOptions(instance, checked);
      if (w.slfw_frames_set_options(this.#frames) !== 0) instance.fail();
    });
  }

  /** [{place, number, time, predicted, lost, offset, bytes}] of the frames that have arrived whole. */
  get list() { return this.#list; }

  /** A light field that does not move whose headers have arrived, and not all of it; its place is 0. Else null. */
  get arriving() {
    const found = this.#list.length === 0 && this.#call((w) => w.slfw_frame(this.#frames, 0) === 0) && this.#about(0);
    return found && found.arriving ? found.frame : null;
  }

  /** It can be used no more: its memory failed, or it was released. */
  get dead() { return this.#instance?.dead ?? true; }

  /** Memory that bytes of the stream take. */
  get heldBytes() { return this.#call((w) => w.slfw_frames_held(this.#frames)); }

  push(bytes) {
    const source = bytesOf(bytes);
    try {
      for (let at = 0; at < source.byteLength; at += CHUNK_BYTES)
        this.#call((w, instance) => {
          const piece = source.subarray(at, at + CHUNK_BYTES);
          if (w.slfw_frames_push(this.#frames, instance.put(piece), piece.byteLength) !== 0) instance.fail();
        });
    } finally {
      if (!this.dead) this.#update();
    }
  }

  /** No bytes follow. */
  finish() {
    this.#call((w, instance) => { if (w.slfw_frames_finish(this.#frames) !== 0) instance.fail(); });
    this.ended = true;
    this.#update();
  }

  /** Whether the bytes of a frame are here; of one that has not arrived they are not. */
  holds(place) {
    if (!Number.isInteger(place) || place < 0) throw invalid('place', 'must be a whole number, 0 or more');
    return place < this.#list.length && this.#about(place).held;
  }

  /** The frame that the group of `place` begins with. */
  groupOf(place) {
    this.#known(place);
    while (this.#list[place]?.predicted && !this.#list[place].lost) --place;
    return place;
  }

  /** Headers of the group of a frame, as SlfDecoder.info has them. */
  info(place = 0) {
    const first = this.groupOf(place);
    if (this.#info.place === first) return this.#info.value;
    const value = this.#headers(first, readCost);
    if (!this.arriving) this.#info = { place: first, value };
    return value;
  }

  /** What decode(place) takes and gives with these options, as SlfDecoder.preflight has it; of a frame that is not predicted. */
  preflight(place, options) {
    const checked = checkedOptions(options);
    return this.#headers(this.#first(place), (instance, stream) => {
      setOptions(instance, checked);
      return preflight(instance, stream);
    });
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
    this.#first(place);
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
    if (place === 0 && this.arriving) return place;
    if (!Number.isInteger(place) || place < 0 || place >= this.#list.length)
      throw invalid('place', `must be a whole number below ${this.#list.length}: so many frames have arrived`);
    return place;
  }

  /** A frame that has headers of its own. */
  #first(place) {
    if (this.#list[this.#known(place)]?.predicted)
      throw invalid('place', `must be that of a frame that is not predicted, as ${this.groupOf(place)} is`);
    return place;
  }

  /** read(instance, stream) of a frame that is not predicted. */
  #headers(place, read) {
    return this.#call((w, instance) => {
      const stream = w.slfw_frame_headers(this.#frames, place);
      if (stream === 0) instance.fail();
      const { onProgress } = instance; // of decodes
      try {
        return read(instance, stream);
      } finally {
        instance.onProgress = onProgress;
        w.slfw_release_stream(stream);
      }
    });
  }

  #update() {
    const count = this.#call((w) => w.slfw_frames_count(this.#frames));
    for (let place = this.#list.length; place < count; ++place) this.#list.push(this.#about(place).frame);
  }

  #about(place) {
    return this.#call((w, instance) => {
      if (w.slfw_frame(this.#frames, place) !== 0) instance.fail();
      const [number, time, offset, bytes, predicted, lost, arriving, held] = instance.numbers(8);
      const frame = { place, number, time, predicted: predicted !== 0, lost: lost !== 0, offset, bytes };
      return { frame, arriving: arriving !== 0, held: held !== 0 };
    });
  }

  /** body(w, instance) */
  #call(body) {
    const instance = this.#instance;
    if (instance === null) throw over('the frames were released');
    return instance.call((w) => body(w, instance));
  }
}
