// SPDX-License-Identifier: Apache-2.0
// WebAssembly: which build, compiled from where, and instances with memory of their own.
import { addressOf, invalid, optionalFunction, over } from './slf_arguments.js';
import { SlfError } from './slf_error.js';

/** (module (func (result v128) i32.const 0 i8x16.splat)): valid only where there is SIMD. */
const SIMD_PROBE = Uint8Array.of(0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 8, 1, 6, 0, 65, 0,
  253, 15, 11);

/** How a `file:` address is read: slf_node.js sets it, so that nothing that a browser runs names node. */
export const files = { read: null };

const NAMES = { simd: 'slf.wasm', scalar: 'slf_scalar.wasm' };

/** Each address stands here in full: bundlers look for this form and for no other. */
function defaultAddress(locateFile) {
  const simd = WebAssembly.validate(SIMD_PROBE);
  const located = locateFile?.(simd ? NAMES.simd : NAMES.scalar);
  if (located) return located;
  return simd ? new URL('./slf.wasm', import.meta.url) : new URL('./slf_scalar.wasm', import.meta.url);
}

/**
 * A module from a module, an address, a response, bytes, or a promise of one of them.
 * @param locateFile  (name) => address of a file of this package, or nothing: where it is by default
 */
export async function compile(source, locateFile) {
  optionalFunction(locateFile, 'locateFile');
  try {
    return await moduleOf((await source) ?? defaultAddress(locateFile));
  } catch (error) {
    if (error instanceof SlfError) throw error;
    if (/content security policy|unsafe-eval/i.test(error?.message))
      throw new SlfError('POLICY', "POLICY: the page's Content-Security-Policy forbids WebAssembly; script-src needs "
        + "'wasm-unsafe-eval'", { cause: error });
    throw new SlfError('NETWORK', `NETWORK: the decoder could not be loaded: ${error.message}`, { cause: error });
  }
}

let shared = null;

/** As compile(); the package's own decoder is compiled once a page, and asked for again where it did not arrive. */
export function decoderModule({ wasm, locateFile } = {}) {
  if (wasm !== undefined || locateFile) return compile(wasm, locateFile);
  shared ??= compile().catch((error) => {
    shared = null;
    throw error;
  });
  return shared;
}

async function moduleOf(source) {
  if (source instanceof WebAssembly.Module) return source;
  if (typeof source === 'string' || source instanceof URL) {
    const address = addressOf(source, 'wasm');
    if (address.startsWith('file:') && files.read) return WebAssembly.compile(await files.read(new URL(address)));
    const response = await fetch(address);
    const type = response.headers.get('content-type') ?? '';
    if (!response.ok || type.startsWith('text/html'))
      throw new Error(`${address} is not there (${response.status} ${type}): copy ${NAMES.simd} and ${NAMES.scalar} `
        + 'of the package to that place, or name them by the options wasm or locateFile');
    source = response;
  }
  if (typeof Response === 'function' && source instanceof Response) {
    if (source.bodyUsed) throw invalid('wasm', 'must be a Response that nobody has read');
    if (!source.ok) throw new Error(`${source.status} ${source.url}`);
    const type = source.headers.get('content-type') ?? '';
    if (WebAssembly.compileStreaming && type.startsWith('application/wasm')) return WebAssembly.compileStreaming(source);
    source = await source.arrayBuffer();
  }
  return WebAssembly.compile(source).catch((error) => {
    throw error instanceof TypeError ? invalid('wasm', 'must be an address, a Response, bytes, a WebAssembly.Module, or a promise of one', error)
      : error;
  });
}

/** What arguments have to be that the decoder itself refuses, by the names that it has for them. */
const REFUSED = {
  levels: 'must be at most those of the file', groups: 'must be at most those of the file',
  layers: 'must be at most those of the group that has most', max_bytes: '(maxBytes) must be 0: frames are read whole',
  points: 'must be below the number of points', directions: 'must be finite, and not 0', finish: '() has been called: nothing follows',
  place: 'must be that of a frame that has arrived, and is neither predicted nor lost',
};

/** One instance of the decoder with its own memory. */
export class Instance {
  #refusal = null; // the error that left it as it was
  #blocks = null;  // of the call that runs

  constructor(module) {
    this.readAt = () => 1;
    this.onProgress = () => 0;
    this.dead = false;
    const nothing = () => 0;
    const { exports } = new WebAssembly.Instance(module, {
      slf: {
        read_at: (to, offset, bytes) => this.readAt(to >>> 0, offset, bytes >>> 0),
        progress: (fraction) => this.onProgress(fraction),
        out_of_memory: () => {
          throw new SlfError('OUT_OF_MEMORY', 'OUT_OF_MEMORY: more than WebAssembly has');
        },
      },
      Math, // sines of directions, exponentials and logarithms of shapes
      // What the C library links: a clock for figures nobody asks for, and output nobody reads.
      wasi_snapshot_preview1: { clock_time_get: nothing, fd_close: nothing, fd_seek: nothing, fd_write: nothing },
    });
    this.wasm = exports;
    exports._initialize();
  }

  /**
   * Runs a call, and frees what it has allocated. A refusal leaves the instance as it was; a trap, a lack of memory in
   * the middle or an exception of the caller's one that is not used again.
   */
  call(body) {
    if (this.dead) throw over('used after a failure or a release');
    this.#blocks = [];
    try {
      return body(this.wasm);
    } catch (error) {
      if (error === this.#refusal) throw error;
      this.dead = true;
      if (error instanceof SlfError) throw error;
      if (error instanceof WebAssembly.RuntimeError)
        throw new SlfError('INTERNAL', `INTERNAL: ${error.message}`, { cause: error });
      throw error; // the caller's own, of a progress function
    } finally {
      if (!this.dead) for (const block of this.#blocks) this.wasm.slfw_free(block);
      this.#blocks = null;
    }
  }

  get bytes() { return this.wasm.memory.buffer.byteLength; }

  /** Throws what the last call that failed has left. */
  fail() {
    const w = this.wasm;
    const text = (which) => this.text(w.slfw_text(which));
    const code = text(0).replace(/^SLF_/, ''), expected = REFUSED[text(1)];
    if (code === 'INVALID_ARGUMENT' && expected) this.refuse(invalid(text(1), expected));
    this.refuse(new SlfError(code, text(3).replace(/^SLF_/, ''),
      { element: text(1), unit: text(2), bitOffset: w.slfw_bit_offset() }));
  }

  /** Throws an error after which all is as it was. */
  refuse(error) {
    this.#refusal = error;
    throw error;
  }

  text(at) {
    const memory = new Uint8Array(this.wasm.memory.buffer);
    let end = at >>>= 0;
    while (memory[end] !== 0) ++end;
    return new TextDecoder().decode(memory.slice(at, end));
  }

  /** The numbers that a call has left, a copy. */
  numbers(count) {
    return Array.from(new Float64Array(this.wasm.memory.buffer, this.wasm.slfw_numbers() >>> 0, count));
  }

  setNumbers(values) {
    new Float64Array(this.wasm.memory.buffer, this.wasm.slfw_numbers() >>> 0, values.length).set(values);
  }

  /** Of a call: until its end. */
  alloc(bytes) {
    const at = bytes < 2 ** 32 ? this.wasm.slfw_alloc(bytes) >>> 0 : 0;
    if (at === 0) this.refuse(new SlfError('OUT_OF_MEMORY', `OUT_OF_MEMORY: ${bytes} bytes`));
    this.#blocks?.push(at);
    return at;
  }

  put(bytes) {
    const at = this.alloc(Math.max(bytes.byteLength, 1));
    new Uint8Array(this.wasm.memory.buffer, at, bytes.byteLength).set(bytes);
    return at;
  }
}
