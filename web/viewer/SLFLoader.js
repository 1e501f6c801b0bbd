// SPDX-License-Identifier: Apache-2.0
// three.js loader of surface light fields.
//
//   import { SLFLoader } from 'slf-decoder/viewer/SLFLoader.js'
//   scene.add(await new SLFLoader().loadAsync('can.slf'))
import { FileLoader, Loader } from 'three';
import { SlfDecoder, decoderModule } from '../slf.js';
import { bytesOf } from '../slf_arguments.js';
import { FieldLoader } from './field_loader.js';
import { DecodeSession, plainError } from './decode_session.js';
import { FrameSession } from './frame_session.js';
import { FrameSource } from './frame_source.js';
import { ViewerError } from './packed_field.js';
import { aborted } from './source_stream.js';
import { moves } from './stream_units.js';
import { SurfaceLightField } from './surface_light_field.js';

/** A decoder for parse() of all loaders of one module: each keeps memory for its next decode. */
const decoders = new WeakMap();
async function decoderOf(module) {
  const compiled = await module;
  if (!decoders.has(compiled)) decoders.set(compiled, SlfDecoder.create({ wasm: compiled }));
  return decoders.get(compiled);
}

// What a caller gives is refused as three and SurfaceLightField refuse it: a TypeError, a RangeError. A ViewerError is a file's.

function partFrom(given) {
  if (typeof given !== 'object' || given === null) throw new TypeError(`setPart(${given}): an object with levels, groups, layers`);
  const wholeOf = (name) => {
    const value = given[name] ?? 0;
    if (Number.isInteger(value) && value >= 0) return value;
    throw new RangeError(`setPart({ ${name}: ${value} }): a whole number; 0: all`);
  };
  return { levels: wholeOf('levels'), groups: wholeOf('groups'), layers: wholeOf('layers') };
}

function checkWorker(worker) {
  if (worker && typeof worker !== 'function') throw new TypeError('SLFLoader.worker: a function that starts a Worker');
  if (!worker && typeof Worker === 'undefined')
    throw new TypeError('SLFLoader.worker: there is no Worker here, as in node. Set one, or use parse()');
}

function wholeFile(buffer) {
  try {
    return bytesOf(buffer);
  } catch (cause) {
    throw new TypeError(`SLFLoader.parse(${buffer === null ? buffer : typeof buffer}): an ArrayBuffer, or a view of one`, { cause });
  }
}

function checkAddress(url, others = '') {
  if (typeof url !== 'string' && !(url instanceof URL)) throw new TypeError(`SLFLoader: ${url} is no address${others}`);
}

/**
 * load(url, onLoad, onProgress, onError), loadAsync(url, onProgress) as every loader of three; both also
 * take a File or Blob. They decode in a worker. parse() decodes on this thread. What is wrong with a file is a ViewerError. What moves
 * shows its first frame, and keeps what decodes the others until it is disposed of.
 */
export class SLFLoader extends Loader {
  #maxMemory = 2 ** 31;

  /**
   * @param {object} parts  where the package's files are, if not beside this one; properties too:
   *   wasm: address, bytes or module of the decoder; worker: () => Worker that runs decode_worker.js, or a promise of one;
   *   locateFile: (name) => address of `slf.wasm` or `slf_scalar.wasm`
   */
  constructor(manager, { wasm, worker, locateFile } = {}) {
    super(manager);
    this.part = {};
    Object.assign(this, { wasm, worker, locateFile });
  }

  /** Fewer octree levels, plane groups or quality layers than the file has; 0: all. */
  setPart(part) {
    this.part = partFrom(part);
    return this;
  }

  /** Bytes that a decode may take; Infinity: what WebAssembly has. */
  get maxMemory() {
    return this.#maxMemory;
  }

  set maxMemory(bytes) {
    if (!(typeof bytes === 'number' && bytes >= 0)) throw new RangeError(`SLFLoader.maxMemory = ${bytes}: bytes, 0 or more, or Infinity`);
    this.#maxMemory = bytes;
  }

  load(url, onLoad, onProgress, onError) {
    const manager = this.manager,
      named = url instanceof Blob ? 'file' : url;
    manager.itemStart(named);
    this.fetch(url, onProgress)
      .then((bytes) => this.decode(bytes))
      .then((object) => {
        onLoad(object);
        manager.itemEnd(named);
      })
      .catch((error) => {
        if (onError) onError(error);
        else console.error(error);
        manager.itemError(named);
        manager.itemEnd(named);
      });
  }

  /**
   * Coarse objects first; of what moves the first frame, while the others arrive.
   * @param onCoarse  called with each, which the next replaces
   */
  async stream(url, onCoarse) {
    checkAddress(url);
    if (typeof onCoarse !== 'function') throw new TypeError('SLFLoader.stream(): onCoarse is a function');
    const field = (packed, info, final) => {
      if (!final) onCoarse(new SurfaceLightField(packed, info));
    };
    return this.decode(this.manager.resolveURL(this.path + url), { field }, {
      headers: this.requestHeader,
      credentials: this.withCredentials ? 'include' : 'same-origin', // as three's own FileLoader
    });
  }

  /**
   * @param {ArrayBuffer|ArrayBufferView} buffer  a whole file
   * @returns {Promise<SurfaceLightField>}
   * @throws {ViewerError} kind 'damaged', 'unsupported', 'too-large', 'memory', 'no-view-maps', 'network', 'policy'
   */
  async parse(buffer) {
    const bytes = wholeFile(buffer);
    if (moves(bytes)) return this.parseFrames(bytes);
    const session = new DecodeSession(() => decoderOf(decoderModule(this)));
    session.append(bytes);
    try {
      const { packed, info } = await session.decode({ ...this.part, budget: this.#budget() });
      return new SurfaceLightField(packed, info);
    } catch (error) {
      throw ViewerError.from(plainError(error));
    } finally {
      session.reset();
    }
  }

  /** As a worker does it: without one, and a frame takes the page as long as its decode takes. */
  async parseFrames(bytes) {
    let over = false;
    const session = new FrameSession(() => decoderOf(decoderModule(this)), (list) => frames.take(list));
    const frames = new FrameSource(async ({ frames: opened, frame }) => {
      try {
        return opened ? await session.open(opened) : await session.decode(frame);
      } catch (error) {
        throw over ? aborted() : ViewerError.from(plainError(error));
      }
    });
    const end = () => {
      over = true;
      session.close();
    };
    try {
      await frames.open(bytes, { ...this.part, budget: this.#budget() });
      return SurfaceLightField.moving(await frames.decode(0), frames, end);
    } catch (error) {
      end();
      throw error;
    }
  }

  /** In whole bytes, as a decoder takes it. */
  #budget() {
    return { maxMemory: Math.min(Math.floor(this.maxMemory), Number.MAX_SAFE_INTEGER) };
  }

  fieldLoader() {
    const { worker, wasm, locateFile } = this;
    checkWorker(worker);
    return new FieldLoader({ worker, wasm, locateFile, ...this.#budget(), mayBeCoarser: false });
  }

  async fetch(url, onProgress) {
    checkWorker(this.worker); // before a file is fetched that none would decode
    if (url instanceof Blob) return url.arrayBuffer();
    checkAddress(url, ', File or Blob');
    const loader = new FileLoader(this.manager);
    loader.setPath(this.path);
    loader.setResponseType('arraybuffer');
    loader.setRequestHeader(this.requestHeader);
    loader.setWithCredentials(this.withCredentials);
    try {
      return await loader.loadAsync(url, onProgress);
    } catch (error) {
      if (error?.name === 'AbortError') throw error;
      throw new ViewerError('network', 'The file cannot be fetched.', `${url}: ${error?.message}`);
    }
  }

  /** @param source, on, request  of FieldLoader.load() */
  async decode(source, on = {}, request = {}) {
    const loader = this.fieldLoader();
    let frames = null;
    const moving = (source) => (frames = source);
    try {
      const first = await loader.load(source, { ...on, moving }, { ...this.part, ...request });
      loader.moving = null; // the worker has it
      return frames
        ? SurfaceLightField.moving(first, frames, () => loader.dispose())
        : new SurfaceLightField(first.packed, first.info);
    } catch (error) {
      frames = null;
      throw error;
    } finally {
      if (!frames) loader.dispose();
    }
  }
}
