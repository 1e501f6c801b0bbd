// SPDX-License-Identifier: Apache-2.0
// Types of slf-decoder/worker. Of what it takes and gives it has the types; the classes are slf-decoder's.
import type { SlfBytes, SlfField, SlfFunctionTable, SlfInfo, SlfOpenOptions, SlfOptions, SlfParts } from './slf.js';
import type { SlfFrameSource, SlfFramesOptions, SlfPlayed } from './slf_frame_stream.js';
import type { SlfReading } from './slf_stream.js';

export type {
  SlfBytes, SlfCode, SlfError, SlfEstimate, SlfField, SlfFrame, SlfFunctionTable, SlfGrid, SlfInfo, SlfKernel, SlfOpenOptions, SlfOptions, SlfParts, WasmSource,
} from './slf.js';
export type { SlfFrameSource, SlfFramesOptions, SlfPlayed } from './slf_frame_stream.js';
export type { SlfReading } from './slf_stream.js';

type SlfArray = 'positions' | 'values' | 'octahedral' | 'weights' | 'meanColours' | 'normals' | 'centres' | 'radii'
  | 'areas' | 'mirrorNormals' | 'covariances' | 'opacities';

/** A field as data, from a worker: the arrays that were asked for. */
export type SlfPlainField =
  Pick<SlfField, 'points' | 'components' | 'functions' | 'partial' | 'grid' | 'directions' | 'transfer' | 'up' | 'rightHanded'
    | 'hasBasis' | 'hasNormals' | 'hasSplats' | 'gamma' | 'kernel' | 'info'>
  & Partial<Pick<SlfField, 'positions' | 'values' | 'octahedral' | 'normals' | 'centres' | 'radii' | 'areas' | 'mirrorNormals'
    | 'covariances' | 'opacities'>>
  & { weights?: Float32Array | null; meanColours?: Uint8Array | null; functionTable?: SlfFunctionTable };

export interface SlfWanted {
  /** Default: all. */
  arrays?: SlfArray[];
  functionTable?: { side?: number };
  /** ABORTED at once; a decode that goes on is not interrupted, its result is dropped. */
  signal?: AbortSignal;
}

/** Decoding in a worker of its own, which runs slf_worker_service.js. */
export class SlfWorker {
  private constructor();
  /** worker: one that runs slf_worker_service.js, or a function that starts one; it has to be given where there is no Worker, as in node. */
  static create(options?: SlfParts & { worker?: Worker | (() => Worker | Promise<Worker>) }): Promise<SlfWorker>;
  info(bytes: SlfBytes): Promise<SlfInfo>;
  decode(bytes: SlfBytes, options?: Omit<SlfOptions, 'onProgress'>, wanted?: SlfWanted & { transfer?: boolean }): Promise<SlfPlainField>;
  open(url: string | URL, options?: SlfOpenOptions): Promise<{
    info: SlfInfo; bytes: number; ranged: boolean; received: number;
    decode(options?: Omit<SlfOptions, 'onProgress'>, wanted?: SlfWanted & SlfReading): Promise<SlfPlainField>;
    close(): Promise<void>;
  }>;
  /** A stream of several frames; frame() gives null behind the last. */
  openFrames(source: SlfFrameSource, options?: Omit<SlfFramesOptions, 'onProgress'>): Promise<{
    info: SlfInfo;
    frame(place: number, wanted?: SlfWanted): Promise<SlfPlayed<SlfPlainField> | null>;
    close(): Promise<void>;
  }>;
  /** Its frames in order; the next is decoded meanwhile. */
  frames(source: SlfFrameSource, options?: Omit<SlfFramesOptions, 'onProgress'>, wanted?: SlfWanted):
    AsyncGenerator<SlfPlayed<SlfPlainField>, void>;
  /** ABORTED for every call that waits, and for every later one. */
  terminate(): void;
}
