// SPDX-License-Identifier: Apache-2.0
// Requests to a server that may stall, break off or know no ranges: every failure is an SlfError.
import { checkSignal, invalid, optionalFunction } from './slf_arguments.js';
import { SlfError } from './slf_error.js';

const MOST_TIMER_MS = 2 ** 31 - 1; // what is longer ends at once
const CREDENTIALS = ['omit', 'same-origin', 'include'];

export function network(message, cause) {
  return new SlfError('NETWORK', `NETWORK: ${message}`, { cause });
}

/** Headers in a plain object, whatever fetch() takes them in. */
function headersOf(given) {
  try {
    return Symbol.iterator in given ? Object.fromEntries(new Headers(given)) : (new Headers(given), given);
  } catch (cause) {
    throw invalid('headers', 'must be names and values of HTTP', cause);
  }
}

/** SlfOpenOptions and `fetch`, checked, as Request takes them. @throws {SlfError} INVALID_ARGUMENT */
export function requestOptions({ signal, fetch: get, headers, credentials, stallMs = 30000 }) {
  checkSignal(signal);
  optionalFunction(get, 'fetch');
  if (credentials !== undefined && !CREDENTIALS.includes(credentials))
    throw invalid('credentials', `must be ${CREDENTIALS.join(', ')}`);
  if (!(typeof stallMs === 'number' && stallMs > 0)) throw invalid('stallMs', 'must be a number of milliseconds above 0, or Infinity');
  return { signal, fetch: get || ((...all) => globalThis.fetch(...all)), headers: headersOf(headers ?? {}), credentials, stallMs };
}

/** Start, end (not included) and size of a Content-Range, or null. */
export function contentRange(response) {
  const match = /^bytes (\d+)-(\d+)\/(\d+)$/.exec(response.headers.get('content-range') ?? '');
  return match && { begin: Number(match[1]), end: Number(match[2]) + 1, size: Number(match[3]) };
}

/** One request at a time: its body, cut off where it stalls or where the caller says so. */
export class Request {
  #timer; #abort = new AbortController(); #stalled = false; #options; #forward;
  #thrown = null; // {error} of a function of the caller

  constructor(options) {
    this.#options = options;
    const { signal } = options;
    this.#forward = () => this.#abort.abort(signal.reason);
    if (signal?.aborted) this.#forward();
    signal?.addEventListener('abort', this.#forward, { once: true });
  }

  async run(url, headers, use) {
    try {
      return await use(await this.#ask(url, headers));
    } catch (error) {
      this.#abort.abort();
      throw this.#explain(error, url);
    } finally {
      clearTimeout(this.#timer);
      this.#options.signal?.removeEventListener('abort', this.#forward);
    }
  }

  /**
   * Pieces of a body as they come; who takes them may wait in between.
   * @param {number} offset  of the first byte that is wanted
   */
  async *pieces(url, offset = 0) {
    try {
      const response = await this.#ask(url, offset > 0 ? { Range: `bytes=${offset}-` } : {});
      let behind = response.status === 206 ? 0 : offset; // a server without ranges sends what is before, too
      const range = contentRange(response);
      if (response.status === 206 && range !== null && range.begin !== offset)
        throw network(`the server gave another part of ${url}`);
      const reader = response.body.getReader();
      for (;;) {
        this.#wait();
        const { done, value } = await reader.read();
        clearTimeout(this.#timer);
        if (done) return;
        if (behind < value.byteLength) yield value.subarray(behind);
        behind = Math.max(0, behind - value.byteLength);
      }
    } catch (error) {
      throw this.#explain(error, url);
    } finally {
      clearTimeout(this.#timer);
      this.#abort.abort();
      this.#options.signal?.removeEventListener('abort', this.#forward);
    }
  }

  async #ask(url, headers) {
    this.#wait();
    const { fetch: get, headers: own, credentials } = this.#options;
    const ask = () => get(url, { headers: { ...own, ...headers }, credentials, signal: this.#abort.signal });
    // Once more where nothing came: a connection that was kept may have been closed by the server.
    const response = await ask().catch((error) => {
      if (this.#abort.signal.aborted) throw error;
      return ask();
    });
    if (!response.ok) throw network(`${response.status} ${response.statusText} for ${url}`.trim());
    return response;
  }

  /** All of a body, at most `most` bytes; `expected` of them where that is known. */
  async body(response, most, expected, told) {
    const parts = [];
    let size = 0;
    const reader = response.body.getReader();
    for (;;) {
      this.#wait();
      const { done, value } = await reader.read();
      if (done) break;
      size += value.byteLength;
      if (size > most) throw network(`more bytes than the ${most} that were asked for`);
      parts.push(value);
      this.#tell(told, size);
    }
    if (expected !== undefined && size !== expected) throw network(`${size} of ${expected} bytes came`);
    const bytes = new Uint8Array(size);
    let at = 0;
    for (const part of parts) {
      bytes.set(part, at);
      at += part.byteLength;
    }
    return bytes;
  }

  #tell(told, size) {
    try {
      told?.(size);
    } catch (error) {
      this.#thrown = { error };
      throw error;
    }
  }

  #wait() {
    clearTimeout(this.#timer);
    if (this.#options.stallMs > MOST_TIMER_MS) return;
    this.#timer = setTimeout(() => {
      this.#stalled = true;
      this.#abort.abort();
    }, this.#options.stallMs);
  }

  #explain(error, url) {
    if (this.#thrown) return error;
    if (this.#stalled) return network(`nothing came for ${this.#options.stallMs} ms from ${url}`, error);
    if (this.#options.signal?.aborted) return new SlfError('ABORTED', 'ABORTED: by the caller', { cause: error });
    return error instanceof SlfError ? error : network(`${url}: ${error.message}`, error);
  }
}
