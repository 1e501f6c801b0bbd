// SPDX-License-Identifier: Apache-2.0
// Types of slf_frame_stream.js: light fields that move, as they arrive.
import type { SlfBytes, SlfDecoder, SlfError, SlfEstimate, SlfField, SlfFrame, SlfInfo, SlfOpenOptions, SlfOptions, WasmSource } from './slf.js';

/** An address, a file, or bytes. */
export type SlfFrameSource = string | URL | Blob | SlfBytes;

export interface SlfFramesOptions extends SlfOpenOptions, SlfOptions {
  /** Bytes of the stream beyond which groups that are behind are dropped, and fetched again by ranges [2^28]; Infinity: none are. */
  keepBytes?: number;
}

/** A frame, and its light field or what is wrong with it. */
export type SlfPlayed<Field> = SlfFrame & ({ field: Field; error: null } | { field: null; error: SlfError });

/** Frames of a source, read as far as they are asked for. */
export class SlfFrameStream {
  private constructor();
  /** Resolves when the first frame is here. */
  static open(source: SlfFrameSource, options?: SlfFramesOptions & {
    decoder?: SlfDecoder; wasm?: WasmSource; fetch?: typeof fetch;
  }): Promise<SlfFrameStream>;
  readonly list: readonly SlfFrame[];
  /** The list is complete. */
  readonly ended: boolean;
  readonly heldBytes: number;
  /** Bytes that have come, those that came again too. */
  readonly received: number;
  info(place?: number): SlfInfo;
  /** As that of SlfFrames, of a frame that is here. */
  preflight(place: number, options?: SlfOptions): SlfEstimate;
  /** Levels, groups, limits of frames that are decoded from here on. */
  setOptions(options?: SlfOptions): void;
  /** Reads until a frame is here, with its group. false: the stream ends before it. */
  arrive(place: number): Promise<boolean>;
  /** Reads a piece of what comes. false: the list is complete, or half of keepBytes is held. */
  readAhead(): Promise<boolean>;
  /** To be released. */
  decode(place: number): Promise<SlfField>;
  /** Frames from a place on, in order. A field lives until the next frame is asked for. */
  play(place?: number): AsyncGenerator<SlfPlayed<SlfField>, void>;
  [Symbol.asyncIterator](): AsyncGenerator<SlfPlayed<SlfField>, void>;
  close(): Promise<void>;
}

/** The frames of a source in order; leaving the loop ends the download. */
export function frames(source: SlfFrameSource, options?: SlfFramesOptions & {
  decoder?: SlfDecoder; wasm?: WasmSource; fetch?: typeof fetch;
}): AsyncGenerator<SlfPlayed<SlfField>, void>;
