// SPDX-License-Identifier: Apache-2.0
// Types of SLFLoader.js.
import type { Loader, LoadingManager } from 'three';
import type { SlfBytes, WasmSource } from '../slf.js';
import type { SurfaceLightField } from './surface_light_field.js';

/** Where the package's files are, if not beside its code. */
export interface SLFParts {
  /** Address, bytes or module of the decoder. */
  wasm?: WasmSource;
  /** Starts a worker that runs `slf-decoder/viewer/decode_worker.js`. */
  worker?: (() => Worker | Promise<Worker>) | null;
  /** Address of `slf.wasm` or `slf_scalar.wasm`; nothing: where it is by default. */
  locateFile?: (name: string) => string | URL | undefined;
}

/**
 * three.js loader of surface light fields: scene.add(await new SLFLoader().loadAsync('can.slf')).
 * load() and loadAsync() also take a File or Blob, and decode in a worker. What moves shows its first frame; its worker
 * decodes the others until it is disposed of. What is wrong with a file is a ViewerError; what the caller gives and is none is a
 * TypeError, a number that is none a RangeError.
 */
export class SLFLoader extends Loader<SurfaceLightField, string | Blob> {
  constructor(manager?: LoadingManager, parts?: SLFParts);

  wasm: SLFParts['wasm'];
  worker: SLFParts['worker'];
  locateFile: SLFParts['locateFile'];

  /**
   * Bytes that decoding may take; more is refused as 'too-large'. 2 GiB; Infinity: what WebAssembly has.
   * @throws {RangeError} set to what is no number from 0 on
   */
  get maxMemory(): number;
  set maxMemory(bytes: number);

  /**
   * Fewer octree levels, plane groups or quality layers than the file has; 0, the default, and more than it has: all.
   * @throws {RangeError} of what is no whole number from 0 on
   */
  setPart(part: { levels?: number; groups?: number; layers?: number }): this;

  /**
   * Coarse objects first: `onCoarse` is called with each, which the next one replaces. What moves comes with its first
   * frame, while the others arrive.
   */
  stream(url: string, onCoarse: (field: SurfaceLightField) => void): Promise<SurfaceLightField>;

  /**
   * A whole file, decoded on this thread.
   * @throws {ViewerError} kind 'damaged', 'unsupported', 'too-large', 'memory', 'no-view-maps', 'network', 'policy'
   * @throws {TypeError} of what is no bytes
   */
  parse(buffer: SlfBytes): Promise<SurfaceLightField>;
}
