// SPDX-License-Identifier: Apache-2.0
import type { WasmSource } from './slf.js';

/** The decoder, from bytes within the bundle: `new SLFLoader(undefined, { wasm })`. Nothing else is fetched. */
export const wasm: Promise<WebAssembly.Module> & WasmSource;
