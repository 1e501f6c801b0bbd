// SPDX-License-Identifier: Apache-2.0
// Files on a server, read in parts: the beginning with the index, then what is asked for.
import { SlfError, SlfDecoder } from './slf.js';
import { addressOf, checkDecoder, checkedOptions, checkSignal, optionalFunction } from './slf_arguments.js';
import { preflight, readInfo, setOptions } from './slf_headers.js';
import { contentRange, network, Request, requestOptions } from './slf_request.js';

const FIRST_BYTES = 1 << 16;

/** Options of a decode, of which nothing is told. */
function quietly(options) {
  return checkedOptions({ ...checkedOptions(options).options, onProgress: undefined });
}

export class SlfStream {
  #url; #options; #decoder; #parts = []; #tag = null; #reading = Promise.resolve();

  /** Use SlfStream.open(). */
  constructor(url, decoder, options) {
    this.#url = url;
    this.#decoder = decoder;
    this.#options = options;
    this.bytes = 0;      // of the whole file
    this.received = 0;   // so far
    this.ranged = false; // the server gives parts
    this.info = null;
  }

  static async open(url, { decoder, wasm, onProgress, ...request } = {}) {
    const address = addressOf(url, 'url', Boolean(request.fetch));
    checkDecoder(decoder);
    optionalFunction(onProgress, 'onProgress');
    const options = requestOptions(request);
    decoder ??= await SlfDecoder.create({ wasm });
    const stream = new SlfStream(address, decoder, options);
    await stream.#begin(onProgress);
    await stream.#retry(() => decoder.withParts(stream.bytes, stream.#at, (instance, opened) => {
      stream.info = readInfo(instance, opened);
    }));
    return stream;
  }

  /** What decode(options) would read of the file that is not here yet, and what it gives. */
  preflight(options) {
    const checked = quietly(options);
    return this.#decoder.withParts(this.bytes, this.#at, (instance, opened) => {
      const ranges = this.#missing(this.#ranges(instance, opened, checked));
      const readBytes = ranges.reduce((sum, range) => sum + range.end - range.begin, 0);
      return { ...preflight(instance, opened), readBytes, requests: ranges.length };
    });
  }

  /** Reads what decode(options) needs. onRead(bytes so far, bytes of this call) */
  async read(options, { onRead, signal = this.#options.signal } = {}) {
    const checked = quietly(options);
    optionalFunction(onRead, 'onRead');
    checkSignal(signal);
    // One after another: what the one before has read need not come again.
    const reading = this.#reading.then(() => this.#read(checked, onRead, signal));
    this.#reading = reading.catch(() => {});
    return reading;
  }

  async #read(checked, onRead, signal) {
    if (signal?.aborted) throw new SlfError('ABORTED', 'ABORTED: by the caller', { cause: signal.reason });
    const ranges = this.#decoder.withParts(this.bytes, this.#at,
      (instance, opened) => this.#missing(this.#ranges(instance, opened, checked)));
    const all = ranges.reduce((sum, range) => sum + range.end - range.begin, 0);
    let before = 0;
    for (const wanted of ranges)
      for (const range of this.#missing([wanted])) { // none, where a server has given the whole file meanwhile
        await this.#fetch(range, (bytes) => onRead?.(before + bytes, all), signal);
        before += range.end - range.begin;
      }
  }

  /** Reads and decodes. */
  async decode(options, reading) {
    await this.read(options, reading);
    return this.#decoder.decodeParts(this.bytes, this.#at, options);
  }

  /** bytes.slice(offset, offset + count), or null where they are not here. */
  #at = (offset, count) => {
    const part = this.#parts.find((p) => p.begin <= offset && offset + count <= p.begin + p.bytes.byteLength);
    return part ? part.bytes.subarray(offset - part.begin, offset - part.begin + count) : this.#pieces(offset, count);
  };

  /** The same from several parts. */
  #pieces(offset, count) {
    const bytes = new Uint8Array(count);
    let at = 0;
    while (at < count) {
      const part = this.#parts.find((p) => p.begin <= offset + at && offset + at < p.begin + p.bytes.byteLength);
      if (!part) {
        this.#wanted = { begin: offset, end: offset + count };
        return null;
      }
      const piece = part.bytes.subarray(offset + at - part.begin, offset + count - part.begin);
      bytes.set(piece, at);
      at += piece.byteLength;
    }
    return bytes;
  }
  #wanted = null;

  /** Calls again with what was missing: the beginning of a file may be longer than the first part. */
  async #retry(call) {
    for (;;) {
      this.#wanted = null;
      try {
        return call();
      } catch (error) {
        if (error.code !== 'READ_FAILED' || this.#wanted === null) throw error;
        for (const range of this.#missing([this.#wanted])) await this.#fetch(range);
      }
    }
  }

  #ranges(instance, opened, checked) {
    const w = instance.wasm;
    setOptions(instance, checked);
    const count = w.slfw_ranges(opened);
    if (count < 0) instance.fail();
    return Array.from({ length: count }, (_, i) => {
      w.slfw_range(i);
      const [offset, bytes] = instance.numbers(2);
      return { begin: offset, end: offset + bytes };
    });
  }

  /** Of ascending ranges what is not here. */
  #missing(ranges) {
    const missing = [];
    for (let { begin, end } of ranges) {
      for (const part of [...this.#parts].sort((a, b) => a.begin - b.begin)) {
        const partEnd = part.begin + part.bytes.byteLength;
        if (partEnd <= begin || part.begin >= end) continue;
        if (part.begin > begin) missing.push({ begin, end: part.begin });
        begin = Math.min(end, partEnd);
      }
      if (begin < end) missing.push({ begin, end });
    }
    return missing;
  }

  #keep(begin, bytes) {
    this.#parts.push({ begin, bytes });
    this.received += bytes.byteLength;
  }

  /** All of the file, where a server gives no parts of it. */
  async #takeWhole(request, response, told) {
    // The length is that before unpacking. Of another origin it is seen, and whether there is packing is not.
    const length = response.headers.get('content-length');
    const packed = response.type === 'cors' || response.headers.has('content-encoding');
    const expected = length !== null && !packed ? Number(length) : undefined;
    const bytes = await request.body(response, Infinity, expected, (n) => told?.(n, expected ?? 0));
    if (this.bytes > 0 && bytes.byteLength !== this.bytes) throw network('the file has changed on the server');
    this.#parts = [];
    this.received = 0;
    this.bytes = bytes.byteLength;
    this.#keep(0, bytes);
  }

  async #begin(told) {
    const request = new Request(this.#options);
    const again = await request.run(this.#url, { Range: `bytes=0-${FIRST_BYTES - 1}` }, async (response) => {
      if (response.status !== 206) return this.#takeWhole(request, response, told).then(() => false);
      const range = contentRange(response);
      if (range === null) { // of another origin that does not let its sizes be seen
        await response.body?.cancel();
        return true;
      }
      if (range.begin !== 0 || range.end !== Math.min(FIRST_BYTES, range.size))
        throw network(`the server gave another part of ${this.#url}`);
      this.bytes = range.size;
      this.ranged = true;
      this.#tag = response.headers.get('etag');
      this.#keep(0, await request.body(response, range.end, range.end, (n) => told?.(n, range.size)));
      return false;
    });
    if (!again) return;
    const plain = new Request(this.#options);
    await plain.run(this.#url, {}, (response) => this.#takeWhole(plain, response, told));
  }

  async #fetch({ begin, end }, told, signal = this.#options.signal) {
    const request = new Request({ ...this.#options, signal });
    await request.run(this.#url, { Range: `bytes=${begin}-${end - 1}` }, async (response) => {
      if (response.status !== 206) return this.#takeWhole(request, response, told);
      const range = contentRange(response);
      const same = range !== null && range.begin === begin && range.end === end;
      if (!same) throw network(`the server gave another part of ${this.#url}`);
      const tag = response.headers.get('etag');
      if (range.size !== this.bytes || (tag && this.#tag && tag !== this.#tag))
        throw network('the file has changed on the server');
      this.#keep(begin, await request.body(response, end - begin, end - begin, told));
    });
  }
}
