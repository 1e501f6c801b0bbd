// SPDX-License-Identifier: Apache-2.0
// What the worker of SlfWorker (slf_worker.js) runs: a decoder, and streams by their number.
import { SlfDecoder, SlfError } from './slf.js';
import { ARRAYS, over } from './slf_arguments.js';
import { SlfFrameStream } from './slf_frame_stream.js';
import { SlfStream } from './slf_stream.js';

const PLAIN = ['points', 'components', 'functions', 'partial', 'grid', 'directions', 'transfer', 'up', 'rightHanded',
  'hasBasis', 'hasNormals', 'hasSplats', 'gamma', 'kernel', 'info'];
/** What a field without a basis does not have. */
const OF_BASIS = ['weights', 'meanColours'];

function arrayOf(field, name) {
  if (!OF_BASIS.includes(name)) return field[name];
  return field.hasBasis ? field[name]() : null;
}

/** An error as data. */
function plainError(error) {
  const { message, element, unit, bitOffset } = error;
  const code = error instanceof SlfError ? error.code : 'INTERNAL'; // a DOMException's code is a number
  return { code, message, element, unit, bitOffset };
}

/** A field as data, with the arrays that were asked for, and what of it can be handed over. */
function plainField(field, { arrays = ARRAYS, functionTable } = {}) {
  try {
    const plain = Object.fromEntries(PLAIN.map((name) => [name, field[name]]));
    const buffers = [];
    for (const name of new Set(arrays)) {
      plain[name] = arrayOf(field, name);
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
    if (source === undefined) throw over('the stream was closed');
    const onRead = (bytes, all) => postMessage({ id, read: [bytes, all] });
    const field = await source.decode(options, { onRead, signal: this.#signal(id) });
    return plainField(field, wanted);
  }

  async openFrames({ id, source, options }) {
    const stream = await SlfFrameStream.open(source, { ...options, decoder: this.#decoder, signal: this.#signal(id) });
    this.#streams.set(id, stream);
    return { plain: { info: stream.info() }, buffers: [] };
  }

  /** What is wrong with a frame is a part of the answer: those behind it may be sound. */
  async frame({ stream, place, wanted }) {
    const source = this.#streams.get(stream);
    if (source === undefined) throw over('the stream was closed');
    if (!(await source.arrive(place))) return { plain: null, buffers: [] };
    const about = { ...source.list[place], field: null, error: null };
    try {
      const { plain, buffers } = plainField(await source.decode(place), wanted);
      return { plain: { ...about, field: plain }, buffers };
    } catch (error) {
      if (!(error instanceof SlfError) || ['ABORTED', 'NETWORK'].includes(error.code)) throw error;
      return { plain: { ...about, error: plainError(error) }, buffers: [] };
    }
  }

  async close({ stream }) { this.#forget(stream); }
  abort(id) {
    this.#aborts.get(id)?.abort();
    this.#forget(id); // of an open() whose answer crossed this
  }
  #forget(id) {
    this.#streams.get(id)?.close?.();
    this.#streams.delete(id);
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
      scope.postMessage({ id: data.id, error: plainError(error) });
    } finally {
      service.done(data.id);
    }
  };
}

serve(globalThis);
postMessage({ ready: true });
