// SPDX-License-Identifier: Apache-2.0
// Decoding off the main thread: the page's side. The worker's is slf_worker_service.js.
//
//     const worker = await SlfWorker.create();
//     const field = await worker.decode(bytes, { levels: 9 }, { arrays: ['positions', 'weights'] });
import { SlfDecoder, SlfError } from './slf.js';
import { addressOf, bytesOf, checkSignal, checkWanted, checkedOptions, invalid, optionalFunction } from './slf_arguments.js';
import { startWorker } from './start_worker.js';

const ownWorker = () => new Worker(new URL('./slf_worker_service.js', import.meta.url), { type: 'module' });

function checkWorker(worker) {
  if (typeof worker?.postMessage !== 'function') throw invalid('worker', 'must be a Worker, or a function that starts one');
}

/** Options of a decode in a worker. */
function checkOptions(options) {
  checkedOptions(options);
  if (options?.onProgress) throw invalid('onProgress', 'is not for decodes in a worker');
}

export class SlfWorker {
  #worker; #next = 0; #waiting = new Map(); #ended = null;

  constructor(worker) {
    this.#worker = worker;
    worker.onmessage = ({ data }) => this.#answer(data);
    worker.onerror = ({ message }) => this.#failAll(message
      ? new SlfError('INTERNAL', `INTERNAL: ${message}`)
      : new SlfError('NETWORK', "NETWORK: the worker's script could not be loaded")); // which has no message
  }

  /** worker: one that runs slf_worker_service.js, or a function that starts one; wasm, locateFile: as of SlfDecoder.create. */
  static async create({ wasm, locateFile, worker } = {}) {
    if (worker && typeof worker !== 'function') checkWorker(worker);
    const { module } = await SlfDecoder.create({ wasm, locateFile });
    if (typeof worker === 'function') checkWorker((worker = await worker()));
    worker ??= await startWorker(ownWorker, () => import('./made/slf_worker_text.js'));
    const client = new SlfWorker(worker);
    await client.#call('create', { module });
    return client;
  }

  async info(bytes) {
    bytesOf(bytes);
    return this.#call('info', { bytes });
  }

  /** options: as of SlfDecoder.decode but onProgress. transfer: hand the bytes over instead of copying them. */
  async decode(bytes, options = {}, { transfer = false, signal, ...wanted } = {}) {
    const { buffer } = bytesOf(bytes), owned = transfer ? [buffer] : [];
    checkOptions(options);
    checkWanted(wanted);
    return this.#call('decode', { bytes, options, wanted }, { transfer: owned, signal });
  }

  async open(url, { signal, stallMs, headers, credentials } = {}) {
    const address = addressOf(url), id = this.#next;
    const opened = await this.#call('open', { url: address, options: { stallMs, headers, credentials } }, { signal });
    return {
      ...opened,
      decode: async (options = {}, { onRead, signal: stop, ...wanted } = {}) => {
        checkOptions(options);
        checkWanted(wanted);
        optionalFunction(onRead, 'onRead');
        return this.#call('decodeStream', { stream: id, options, wanted }, { onRead, signal: stop });
      },
      close: () => this.#call('close', { stream: id }),
    };
  }

  /** A stream of several frames. source: an address, a Blob or bytes; options: as of SlfFrameStream.open but fetch. */
  async openFrames(source, { signal, ...options } = {}) {
    const id = this.#next;
    const from = typeof source === 'string' || source instanceof URL ? addressOf(source, 'source') : source;
    const { info } = await this.#call('openFrames', { source: from, options }, { signal });
    return {
      info,
      frame: async (place, { signal: stop, ...wanted } = {}) => {
        checkWanted(wanted); // what is wrong with it is no matter of the frame's
        const frame = await this.#call('frame', { stream: id, place, wanted }, { signal: stop });
        return frame?.error ? { ...frame, error: new SlfError(frame.error.code, frame.error.message, frame.error) } : frame;
      },
      close: () => this.#call('close', { stream: id }),
    };
  }

  /** The frames of a source in order, as SlfFrameStream.play() has them; the next is decoded meanwhile. */
  async *frames(source, options = {}, wanted = {}) {
    const { signal } = options, stream = await this.openFrames(source, options);
    const ask = (place) => {
      const asked = stream.frame(place, { ...wanted, signal });
      asked.catch(() => {}); // said when it is its turn
      return asked;
    };
    try {
      let next = ask(0);
      for (let frame = await next; frame !== null; frame = await next) {
        next = ask(frame.place + 1);
        yield frame;
      }
    } finally {
      if (this.#ended === null) await stream.close();
    }
  }

  terminate() {
    this.#worker.terminate();
    this.#failAll(new SlfError('ABORTED', 'ABORTED: the worker was ended'));
  }

  #call(call, message, { transfer = [], signal, onRead } = {}) {
    const id = this.#next++;
    return new Promise((resolve, reject) => {
      if (this.#ended) throw this.#ended;
      checkSignal(signal);
      const aborted = () => new SlfError('ABORTED', 'ABORTED: by the caller', { cause: signal.reason });
      if (signal?.aborted) throw aborted();
      // A decode that goes on in the worker is not interrupted: its result is dropped.
      const stop = () => {
        this.#worker.postMessage({ call: 'abort', which: id });
        this.#waiting.get(id)?.reject(aborted());
        this.#waiting.delete(id);
      };
      const settle = (then) => (value) => {
        signal?.removeEventListener('abort', stop);
        then(value);
      };
      try {
        this.#worker.postMessage({ id, call, ...message }, transfer);
      } catch (error) {
        throw new SlfError('INVALID_ARGUMENT', `INVALID_ARGUMENT: ${error.message}`, { cause: error });
      }
      this.#waiting.set(id, { resolve: settle(resolve), reject: settle(reject), onRead });
      signal?.addEventListener('abort', stop, { once: true });
    });
  }

  #answer({ id, result, error, read }) {
    const waiting = this.#waiting.get(id);
    if (waiting === undefined) return;
    if (read) return waiting.onRead?.(...read);
    this.#waiting.delete(id);
    if (error) return waiting.reject(new SlfError(error.code, error.message, error));
    waiting.resolve(result);
  }

  #failAll(error) {
    this.#ended = error;
    for (const { reject } of this.#waiting.values()) reject(error);
    this.#waiting.clear();
  }
}
