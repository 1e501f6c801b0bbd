// Decoding off the main thread. This file is both sides: the page imports SlfWorker from it, the
// worker that SlfWorker starts runs it.
//
//     const worker = await SlfWorker.create();
//     const field = await worker.decode(bytes, { levels: 9 }, { arrays: ['positions', 'weights'] });
import { SlfDecoder, SlfError } from './slf.js';
import { SlfStream } from './slf_stream.js';

const NAME = 'slf decoder';
const PLAIN = ['points', 'components', 'functions', 'partial', 'grid', 'frame', 'transfer', 'up', 'rightHanded',
  'hasBasis', 'hasNormals', 'gamma', 'kernel', 'info'];
const READERS = {
  positions: (field) => field.positions,
  values: (field) => field.values,
  octahedral: (field) => field.octahedral,
  weights: (field) => (field.hasBasis ? field.weights() : null),
  meanColours: (field) => (field.hasBasis ? field.meanColours() : null),
  normals: (field) => field.normals,
  centres: (field) => field.centres,
  radii: (field) => field.radii,
  areas: (field) => field.areas,
  frameNormals: (field) => field.frameNormals,
};

function invalid(what) { return new SlfError('INVALID_ARGUMENT', `INVALID_ARGUMENT: ${what}`); }

/** A field as data, with the arrays that were asked for, and what of it can be handed over. */
function plainField(field, { arrays = Object.keys(READERS), functionTable } = {}) {
  try {
    const plain = Object.fromEntries(PLAIN.map((name) => [name, field[name]]));
    const buffers = [];
    for (const name of new Set(arrays)) {
      if (!Object.keys(READERS).includes(name)) throw invalid(`no array is called ${name}`);
      plain[name] = READERS[name](field);
      if (plain[name]) buffers.push(plain[name].buffer);
    }
    if (functionTable && field.hasBasis) {
      plain.functionTable = field.functionTable(functionTable);
      buffers.push(plain.functionTable.data.buffer);
    }
    return { plain, buffers };
  } finally {
    field.release();
  }
}

class Service {
  #decoder; #streams = new Map(); #aborts = new Map();

  async create({ module }) { this.#decoder = await SlfDecoder.create({ wasm: module }); }
  async info({ bytes }) { return { plain: this.#decoder.info(bytes), buffers: [] }; }
  async decode({ bytes, options, wanted }) { return plainField(this.#decoder.decode(bytes, options), wanted); }

  async open({ id, url, options }) {
    const stream = await SlfStream.open(url, { ...options, decoder: this.#decoder, signal: this.#signal(id) });
    this.#streams.set(id, stream);
    return { plain: { info: stream.info, bytes: stream.bytes, ranged: stream.ranged, received: stream.received },
      buffers: [] };
  }

  async decodeStream({ id, stream, options, wanted }) {
    const source = this.#streams.get(stream);
    if (source === undefined) throw invalid('the stream was closed');
    const onRead = (bytes, all) => postMessage({ id, read: [bytes, all] });
    const field = await source.decode(options, { onRead, signal: this.#signal(id) });
    return plainField(field, wanted);
  }

  async close({ stream }) { this.#streams.delete(stream); }
  abort(id) {
    this.#aborts.get(id)?.abort();
    this.#streams.delete(id); // of an open() whose answer crossed this
  }
  done(id) { this.#aborts.delete(id); }

  #signal(id) {
    const abort = new AbortController();
    this.#aborts.set(id, abort);
    return abort.signal;
  }
}

function serve(scope) {
  const service = new Service();
  scope.onmessage = async ({ data }) => {
    if (data.call === 'abort') return service.abort(data.which);
    try {
      const answer = await service[data.call](data);
      scope.postMessage({ id: data.id, result: answer?.plain }, answer?.buffers ?? []);
    } catch (error) {
      const { message, element, unit, bitOffset } = error;
      const code = error instanceof SlfError ? error.code : 'INTERNAL'; // a DOMException's code is a number
      scope.postMessage({ id: data.id, error: { code, message, element, unit, bitOffset } });
    } finally {
      service.done(data.id);
    }
  };
}

if (typeof WorkerGlobalScope !== 'undefined' && globalThis instanceof WorkerGlobalScope && globalThis.name === NAME)
  serve(globalThis);

export class SlfWorker {
  #worker; #next = 0; #waiting = new Map(); #ended = null;

  constructor(worker) {
    this.#worker = worker;
    worker.onmessage = ({ data }) => this.#answer(data);
    worker.onerror = ({ message }) => this.#failAll(message
      ? new SlfError('INTERNAL', `INTERNAL: ${message}`)
      : new SlfError('NETWORK', "NETWORK: the worker's script could not be loaded")); // which has no message
  }

  /** worker: one that runs this file under the name `slf decoder`; wasm: as of SlfDecoder.create. */
  static async create({ wasm, worker } = {}) {
    const { module } = await SlfDecoder.create({ wasm });
    worker ??= new Worker(new URL('./slf_worker.js', import.meta.url), { type: 'module', name: NAME });
    const client = new SlfWorker(worker);
    await client.#call('create', { module });
    return client;
  }

  info(bytes) { return this.#call('info', { bytes }); }

  /** options: as of SlfDecoder.decode but onProgress. transfer: hand the bytes over instead of copying them. */
  decode(bytes, options = {}, { transfer = false, signal, ...wanted } = {}) {
    const owned = transfer ? [bytes instanceof ArrayBuffer ? bytes : bytes.buffer] : [];
    return this.#call('decode', { bytes, options, wanted }, { transfer: owned, signal });
  }

  async open(url, { signal, stallMs, headers, credentials } = {}) {
    let address;
    try {
      address = new URL(url, globalThis.location?.href).href;
    } catch (cause) {
      throw new SlfError('INVALID_ARGUMENT', `INVALID_ARGUMENT: ${url} is no address`, { cause });
    }
    const id = this.#next;
    const opened = await this.#call('open', { url: address, options: { stallMs, headers, credentials } }, { signal });
    return {
      ...opened,
      decode: (options = {}, { onRead, signal: stop, ...wanted } = {}) =>
        this.#call('decodeStream', { stream: id, options, wanted }, { onRead, signal: stop }),
      close: () => this.#call('close', { stream: id }),
    };
  }

  terminate() {
    this.#worker.terminate();
    this.#failAll(new SlfError('ABORTED', 'ABORTED: the worker was ended'));
  }

  #call(call, message, { transfer = [], signal, onRead } = {}) {
    const id = this.#next++;
    return new Promise((resolve, reject) => {
      if (this.#ended) throw this.#ended;
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
