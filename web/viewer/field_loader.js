// SPDX-License-Identifier: Apache-2.0
// From a file, an address or bytes to packed light fields: coarse ones while the rest arrives. The worker that decodes
// ends when nothing is left to decode, and with it the memory that it has grown to; another starts for the next.
import { decoderModule } from '../slf.js';
import { startWorker } from '../start_worker.js';
import { plainError } from './decode_session.js';
import { FrameSource } from './frame_source.js';
import { ViewerError } from './packed_field.js';
import { aborted, openStream } from './source_stream.js';
import { moves } from './stream_units.js';

const MOST_BYTES = 2 ** 30, // of a file
  MOST_MEMORY = 3500 * 2 ** 20;
const FIRST_LOOK = 4096,
  GROWTH = 2; // bytes at which a prefix is decoded, and how much later the next
const LARGE = 200_000,
  LOOK = 65_536; // bytes of a file that came at once, and of its first picture

/** One worker that holds one file at a time. */
export class FieldLoader {
  /**
   * @param {object} options  worker: () => Worker that runs decode_worker.js, or a promise of one; wasm, locateFile: as
   *   of SlfDecoder.create(); maxMemory, mayBeCoarser: of a Budget (part.js); stallMs: a server that sends nothing for so long
   *   is given up
   */
  constructor({ worker = null, wasm, locateFile, maxMemory = 2 ** 31, mayBeCoarser = true, stallMs = 30000 } = {}) {
    this.start = worker ?? newWorker;
    this.wasm = wasm;
    this.locateFile = locateFile;
    this.module = null; // a promise of the compiled decoder, for every worker
    this.maxMemory = maxMemory;
    this.mayBeCoarser = mayBeCoarser;
    this.maxPoints = Infinity;
    this.groupsFirst = false;
    this.stallMs = stallMs;
    this.waiting = new Map();
    this.next = 1;
    this.turn = 0;
    this.arriving = new AbortController(); // of the file that is on its way
    this.whole = false; // all of it is here
    this.kept = null; // its bytes, while there is no worker
    this.resting = null; // a promise of its end, or of the next
    this.busy = 0; // decodes that are going on
    this.frames = null; // a FrameSource, of a light field that moves
    this.moving = null; // its source
    this.stopped = null; // why the worker answers no more
  }

  /** @param {boolean} all  whatever it takes, as far as WebAssembly has it */
  budget(all = false) {
    const { maxPoints, mayBeCoarser, groupsFirst } = this;
    return { maxMemory: all ? MOST_MEMORY : this.maxMemory, maxPoints, mayBeCoarser, groupsFirst };
  }

  /**
   * Loads and decodes; a load that is going on is given up.
   * @param {string|URL|Blob|ArrayBuffer|Uint8Array} source
   * @param {object} on  progress(received, total or 0), field(packed, info, final, coarser): of DecodeSession.decode(); moving(frames): a FrameSource, of a
   *   light field that moves, which without it is its first frame
   * @param {object} options  levels, groups, layers, all: as they are at each decode; signal; headers, credentials: of fetch
   * @returns {Promise<{packed, info, bytes, part}>} of the whole file; part: levels, groups, layers that were decoded
   * @throws {ViewerError}
   */
  async load(source, on = {}, options = {}) {
    this.dispose();
    const turn = this.turn;
    this.stopped = this.frames = null;
    this.whole = false;
    const arriving = (this.arriving = new AbortController()),
      { signal } = arriving,
      stop = () => arriving.abort();
    const current = () => turn === this.turn && !signal.aborted;
    if (options.signal?.aborted) stop();
    options.signal?.addEventListener('abort', stop, { once: true });
    try {
      return await this.receive(source, on, options, current, signal);
    } finally {
      options.signal?.removeEventListener('abort', stop);
      stop(); // a body that was refused before its end
    }
  }

  async receive(source, on, options, current, signal) {
    const { headers, credentials } = options;
    const [stream] = await Promise.all([
      openStream(source, { signal, headers, credentials }, this.stallMs),
      this.restart(current),
    ]);
    if (stream.total > MOST_BYTES) throw new ViewerError('too-large', `This file has ${stream.total} bytes.`);
    let received = 0,
      look = FIRST_LOOK,
      looking = null,
      pace = 0; // milliseconds a byte of the prefix before
    const begin = performance.now();
    const showPrefix = (prefix) => {
      const from = performance.now();
      looking = this.decode({ ...options, prefix })
        .then(({ packed, info }) => packed && current() && on.field(packed, info, false))
        .catch(() => {}) // what is wrong with a prefix is said of the whole file
        .finally(() => {
          looking = null;
          pace = (performance.now() - from) / prefix;
        });
    };
    // Each is decoded from the beginning: one that may be done after the rest has come would delay the whole.
    const inTime = () => !(stream.total > 0) || pace * received <= (performance.now() - begin) * (stream.total / received - 1);
    let head = new Uint8Array(0),
      moving = on.moving ? null : false;
    for await (const chunk of stream.chunks) {
      if (!current()) throw aborted();
      if (moving === null) moving = moves((head = joined(head, chunk)));
      if (moving) return this.receiveFrames(source, on, options, current);
      received += chunk.length;
      if (received > MOST_BYTES) throw new ViewerError('too-large', `This file has more than ${MOST_BYTES} bytes.`);
      this.worker.postMessage({ append: chunk });
      on.progress?.(received, received > stream.total ? 0 : stream.total);
      if (!on.field || looking || received < look || received === stream.total || !inTime()) continue;
      look = received * GROWTH;
      showPrefix(received);
    }
    if (stream.exact && received < stream.total)
      throw new ViewerError('network', `The connection ended after ${received} of ${stream.total} bytes.`);
    if (on.field && look === FIRST_LOOK && received > LARGE) showPrefix(LOOK);
    await looking;
    if (!current()) throw aborted();
    this.whole = true;
    const { levels = 0, groups = 0, layers = 0, all } = options,
      part = { levels, groups, layers };
    const result = await this.decode({ ...part, all });
    if (!current()) throw aborted();
    on.field?.(result.packed, result.info, true, result.coarser);
    return { ...result, bytes: received, part };
  }

  async receiveFrames(source, on, options, current) {
    const { levels = 0, groups = 0, layers = 0 } = options,
      part = { levels, groups, layers };
    this.worker.postMessage({ reset: true });
    this.moving = source;
    const frames = await this.openFrames({ ...options, ...part });
    const first = await frames.decode(0);
    if (!current()) throw aborted();
    on.moving(frames);
    on.field?.(first.packed, first.info, true, frames.coarser);
    return { ...first, bytes: frames.ended ? frames.bytes : 0, part };
  }

  /** A light field that moves: the worker reads the file by itself, as far ahead as memory allows. */
  async openFrames({ levels = 0, groups = 0, layers = 0, all, headers, credentials }) {
    const frames = (this.frames = new FrameSource((message) => this.ask(message))),
      { stallMs } = this;
    await frames.open(this.moving, { levels, groups, layers, headers, credentials, stallMs, budget: this.budget(all) });
    return frames;
  }

  /** Decodes what is loaded once more, with other levels, groups or layers. */
  async decode({ prefix = 0, levels = 0, groups = 0, layers = 0, all } = {}) {
    const { turn } = this;
    ++this.busy;
    try {
      await this.wake();
      return await this.ask({ decode: { prefix, levels, groups, layers, budget: this.budget(all) } });
    } finally {
      if (--this.busy === 0 && this.whole && this.worker && !this.stopped && turn === this.turn) this.rest(turn);
    }
  }

  /** Ends the worker; it hands over the file. */
  rest(turn) {
    this.turning(turn, this.ask({ give: true }).then(({ bytes }) => {
      if (turn !== this.turn) return;
      this.kept = bytes;
      this.worker.terminate?.();
      this.worker = null;
    })).catch(() => {}); // of a worker that has stopped, or is of another file
  }

  /** A worker that has the file, where the one before was ended. */
  async wake() {
    const { turn } = this;
    while (this.resting && turn === this.turn) await this.resting;
    const { kept } = this;
    if (!kept || turn !== this.turn) return;
    this.kept = null;
    try {
      await this.turning(turn, this.restart(() => turn === this.turn));
      this.worker.postMessage({ append: kept }, [kept.buffer]);
    } catch (error) {
      if (turn === this.turn) this.kept = kept;
      throw error;
    }
  }

  /** Whoever wants to decode waits for it. */
  turning(turn, change) {
    this.resting = change.finally(() => {
      if (turn === this.turn) this.resting = null;
    });
    return this.resting;
  }

  /** The worker's answer to a message. */
  async ask(message) {
    if (this.stopped) throw this.stopped;
    if (!this.worker) throw aborted();
    const id = this.next++;
    const answered = new Promise((resolve, reject) => this.waiting.set(id, { resolve, reject }));
    this.worker.postMessage({ id, ...message });
    return answered;
  }

  /** Frees the worker and its memory. */
  dispose() {
    ++this.turn;
    this.arriving.abort();
    this.worker?.terminate?.();
    this.worker = this.kept = this.resting = null;
    for (const { reject } of this.waiting.values()) reject(aborted());
    this.waiting.clear();
  }

  /** A new worker for every file: memory that WebAssembly has grown to is never given back otherwise. */
  async restart(current) {
    const worker = await this.startWorker();
    const module = await this.decoder();
    if (!current()) {
      worker.terminate?.();
      throw aborted();
    }
    this.worker = worker;
    worker.onmessage = ({ data }) => this.answered(data);
    worker.onerror = (event) => {
      event.preventDefault?.();
      this.stopped = event.message
        ? new ViewerError('memory', 'The decoder stopped.', event.message)
        : new ViewerError('network', 'The decoder, a part of this page, did not arrive.'); // that has no message
      for (const { reject } of this.waiting.values()) reject(this.stopped);
      this.waiting.clear();
    };
    worker.postMessage({ wasm: module });
  }

  async startWorker() {
    try {
      return await this.start();
    } catch (error) {
      throw new ViewerError('network', 'The decoder, a part of this page, did not arrive.', error?.message);
    }
  }

  /** One that did not arrive is asked for once more, and again by the next file. */
  async decoder(again = true) {
    this.module ??= decoderModule(this);
    try {
      return await this.module;
    } catch (error) {
      this.module = null;
      return again && error.code === 'NETWORK' ? this.decoder(false) : refused(error);
    }
  }

  answered(data) {
    if (data.list) return this.frames?.take(data.list);
    const own = this.waiting.get(data.id);
    if (!own) return;
    this.waiting.delete(data.id);
    if (data.error) own.reject(Object.assign(ViewerError.from(data.error), { info: data.info }));
    else own.resolve(data);
  }
}

const refused = (error) => {
  throw ViewerError.from(plainError(error));
};

const ownWorker = () => new Worker(new URL('./decode_worker.js', import.meta.url), { type: 'module' });
const newWorker = () => startWorker(ownWorker, () => import('../made/decode_worker_text.js'));

function joined(a, b) {
  const both = new Uint8Array(a.length + b.length);
  both.set(a);
  both.set(b, a.length);
  return both;
}
