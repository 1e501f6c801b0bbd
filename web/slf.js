// SPDX-License-Identifier: Apache-2.0
// The decoder of surface light fields as an ES module: browser, worker, node. No dependency.
//
//     const decoder = await SlfDecoder.create();
//     const field = decoder.decode(bytes, { levels: 8 });
//     field.positions, field.values, field.weights() ...
//     field.release();
//
// Types and documentation: slf.d.ts.
import { bytesOf, checkedOptions } from './slf_arguments.js';
import { SlfField } from './slf_field.js';
import { SlfFrames } from './slf_frames.js';
import { preflight, readCost, readInfo, setOptions } from './slf_headers.js';
import { Instance, compile } from './slf_instance.js';

/**
 * WebAssembly memory never shrinks. An instance of up to KEPT_BYTES is used again, since half of a decode is the system
 * giving it memory; one beyond SMALL_BYTES for KEPT_MS, which covers the prefixes of a file that is still on its way.
 */
const KEPT_BYTES = 512 << 20, SMALL_BYTES = 32 << 20, KEPT_MS = 5000;

export class SlfDecoder {
  #module; #idle = null; #timer;

  /** Use SlfDecoder.create(). */
  constructor(module) { this.#module = module; }

  static async create({ wasm, locateFile } = {}) { return new SlfDecoder(await compile(wasm, locateFile)); }

  /** The compiled module: may be posted to workers and given to their create(). */
  get module() { return this.#module; }

  info(bytes) {
    return this.#withStream(bytes, readCost);
  }

  preflight(bytes, options) {
    const checked = checkedOptions(options);
    return this.#withStream(bytes, (instance, stream) => {
      setOptions(instance, checked);
      return preflight(instance, stream);
    });
  }

  decode(bytes, options) {
    const source = bytesOf(bytes);
    return this.#field((instance) => instance.wasm.slfw_open(instance.put(source), source.byteLength), options);
  }

  /** Of a stream that is read in parts. readAt(offset, bytes): Uint8Array, or null. */
  decodeParts(size, readAt, options) {
    return this.#field((instance) => this.openParts(instance, size, readAt), options);
  }

  /** A reader of a stream of several frames, whose bytes are pushed as they come. */
  frames(options) {
    const checked = checkedOptions(options);
    return new SlfFrames(this.take(), checked, (used) => this.give(used));
  }

  /** Calls use(instance, stream) with a stream that is read in parts. */
  withParts(size, readAt, use) {
    const instance = this.take();
    try {
      return instance.call((w) => {
        const stream = this.openParts(instance, size, readAt);
        if (stream === 0) instance.fail();
        try {
          return use(instance, stream);
        } finally {
          w.slfw_release_stream(stream);
        }
      });
    } finally {
      this.give(instance);
    }
  }

  openParts(instance, size, readAt) {
    instance.readAt = (to, offset, bytes) => {
      const part = readAt(offset, bytes);
      if (part === null) return 1;
      new Uint8Array(instance.wasm.memory.buffer, to, bytes).set(part);
      return 0;
    };
    return instance.wasm.slfw_open_reader(size);
  }

  take() {
    const instance = this.#idle ?? new Instance(this.#module);
    this.trim();
    return instance;
  }

  give(instance) {
    instance.readAt = () => 1;
    instance.onProgress = () => 0;
    if (instance.dead || instance.bytes > KEPT_BYTES) return;
    this.trim();
    this.#idle = instance;
    if (instance.bytes <= SMALL_BYTES) return;
    this.#timer = setTimeout(() => this.trim(), KEPT_MS);
    this.#timer.unref?.(); // node need not wait for it
  }

  trim() {
    clearTimeout(this.#timer);
    this.#idle = null;
  }

  /** open(instance) */
  #field(open, options) {
    const checked = checkedOptions(options), instance = this.take();
    try {
      const { field, info } = instance.call((w) => {
        setOptions(instance, checked);
        const stream = open(instance);
        if (stream === 0) instance.fail();
        const about = readInfo(instance, stream);
        const decoded = w.slfw_decode(stream);
        w.slfw_release_stream(stream);
        if (decoded === 0) instance.fail();
        return { field: decoded, info: about };
      });
      return new SlfField(instance, field, info, (used) => this.give(used));
    } catch (error) {
      instance.dead = true; // may hold what was not given back
      throw error;
    }
  }

  #withStream(bytes, use) {
    const source = bytesOf(bytes), instance = this.take();
    try {
      return instance.call((w) => {
        const stream = w.slfw_open(instance.put(source), source.byteLength);
        if (stream === 0) instance.fail();
        const result = use(instance, stream);
        w.slfw_release_stream(stream);
        return result;
      });
    } catch (error) {
      instance.dead = true; // may hold what was not given back
      throw error;
    } finally {
      this.give(instance);
    }
  }
}

export { SlfError } from './slf_error.js';
export { decoderModule } from './slf_instance.js';
export { SlfField, SlfFrames };
