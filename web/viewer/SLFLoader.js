// SPDX-License-Identifier: Apache-2.0
// three.js loader of surface light fields.
//
//   import { SLFLoader } from 'slf-decoder/viewer/SLFLoader.js'
//   scene.add(await new SLFLoader().loadAsync('can.slf'))
import { FileLoader, Loader } from 'three';
import { SlfDecoder, decoderModule } from '../slf.js';
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

/**
 * load(url, onLoad, onProgress, onError), loadAsync(url, onProgress) as every loader of three; both also
 * take a File or Blob. They decode in a worker. parse() decodes on this thread. Every error is a ViewerError. What moves
 * shows its first frame, and keeps what decodes the others until it is disposed of.
 */
export class SLFLoader extends Loader {
  /**
   * @param {object} parts  where the package's files are, if not beside this one; properties too:
   *   wasm: address, bytes or module of the decoder; worker: () => Worker that runs decode_worker.js, or a promise of one;
   *   locateFile: (name) => address of `slf.wasm` or `slf_scalar.wasm`
   */
  constructor(manager, { wasm, worker, locateFile } = {}) {
    super(manager);
    this.part = {};
    this.maxMemory = 2 ** 31;
    Object.assign(this, { wasm, worker, locateFile });
  }

  /** Fewer octree levels, plane groups or quality layers than the file has; 0: all. */
  setPart({ levels = 0, groups = 0, layers = 0 }) {
    this.part = { levels, groups, layers };
    return this;
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
  stream(url, onCoarse) {
    const field = (packed, info, final) => {
      if (!final) onCoarse(new SurfaceLightField(packed, info));
    };
    return this.decode(this.manager.resolveURL(this.path + url), { field }, {
      headers: this.requestHeader,
      credentials: this.withCredentials ? 'include' : 'same-origin', // as three's own FileLoader
    });
  }

  /**
   * @param {ArrayBuffer|Uint8Array} buffer  a whole file
   * @returns {Promise<SurfaceLightField>}
   * @throws {ViewerError} kind 'damaged', 'unsupported', 'too-large', 'memory', 'no-view-maps', 'network', 'policy'
   */
  async parse(buffer) {
    if (moves(new Uint8Array(buffer))) return this.parseFrames(new Uint8Array(buffer));
    const session = new DecodeSession(() => decoderOf(decoderModule(this)));
    session.append(new Uint8Array(buffer));
    try {
      const { packed, info } = await session.decode({ ...this.part, budget: { maxMemory: this.maxMemory } });
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
      await frames.open(bytes, { ...this.part, budget: { maxMemory: this.maxMemory } });
      return SurfaceLightField.moving(await frames.decode(0), frames, end);
    } catch (error) {
      end();
      throw error;
    }
  }

  fieldLoader() {
    const { worker, wasm, locateFile, maxMemory } = this;
    return new FieldLoader({ worker, wasm, locateFile, maxMemory, mayBeCoarser: false });
  }

  async fetch(url, onProgress) {
    if (url instanceof Blob) return url.arrayBuffer();
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
