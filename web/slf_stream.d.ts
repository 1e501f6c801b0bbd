// SPDX-License-Identifier: Apache-2.0
// Types of slf_stream.js: files on a server.
import type { SlfDecoder, SlfEstimate, SlfField, SlfInfo, SlfOpenOptions, SlfOptions, WasmSource } from './slf.js';

/** How a read tells of itself, and is ended. */
export interface SlfReading {
  /** Bytes so far, and all of this call. */
  onRead?: (bytes: number, all: number) => void;
  signal?: AbortSignal;
}

/** A file on a server, read in parts by its index; all of it where the server ignores ranges. */
export class SlfStream {
  private constructor();
  static open(url: string | URL, options?: SlfOpenOptions & {
    decoder?: SlfDecoder; wasm?: WasmSource; fetch?: typeof fetch; onProgress?: (received: number, all: number) => void;
  }): Promise<SlfStream>;
  readonly info: SlfInfo;
  /** Of the whole file, and received so far. */
  readonly bytes: number;
  readonly received: number;
  /** The server gives parts. */
  readonly ranged: boolean;
  preflight(options?: SlfOptions): SlfEstimate;
  /** Reads what decode(options) needs and is not here yet; after the reads that were asked for before. */
  read(options?: SlfOptions, reading?: SlfReading): Promise<void>;
  decode(options?: SlfOptions, reading?: SlfReading): Promise<SlfField>;
}
