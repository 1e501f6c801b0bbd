// SPDX-License-Identifier: Apache-2.0
// What a caller gives, checked where it enters: before memory is taken, a byte is asked for or a worker hears of it.
import { SlfError } from './slf_error.js';

/** @param {string} expected  behind the argument's name: what it has to be */
export function invalid(argument, expected, cause) {
  return new SlfError('INVALID_ARGUMENT', `INVALID_ARGUMENT: ${argument} ${expected}`, { element: argument, cause });
}

/** What is asked of something that is over. */
export function over(words) { return new SlfError('INVALID_ARGUMENT', `INVALID_ARGUMENT: ${words}`); }

/** By their tags: those of another frame, or of another realm of node, are no instances of ours. */
const BUFFERS = ['[object ArrayBuffer]', '[object SharedArrayBuffer]'];

/** @param {string} expected  where more than bytes will do */
export function bytesOf(source, name = 'bytes', expected = 'an ArrayBuffer or a view of one') {
  if (source instanceof Uint8Array) return source;
  if (ArrayBuffer.isView(source)) return new Uint8Array(source.buffer, source.byteOffset, source.byteLength);
  if (BUFFERS.includes(Object.prototype.toString.call(source))) return new Uint8Array(source);
  throw invalid(name, `must be ${expected}`);
}

function whole(options, name, most = Number.MAX_SAFE_INTEGER) {
  const value = options[name] ?? 0;
  if (!Number.isInteger(value) || value < 0 || value > most) throw invalid(name, `must be a whole number, 0 to ${most}`);
  return value;
}

/** Infinity is no limit. */
function limit(options, name) {
  if (options[name] === Infinity) return Number.MAX_SAFE_INTEGER;
  const value = options[name] ?? 0;
  if (Number.isSafeInteger(value) && value >= 0) return value;
  throw invalid(name, `must be a whole number, 0 to ${Number.MAX_SAFE_INTEGER}, or Infinity`);
}

export function optionalFunction(value, name) {
  if (value && typeof value !== 'function') throw invalid(name, 'must be a function');
  return value || undefined;
}

function corner(region, side) {
  const at = region[side];
  if (at?.length !== 3 || !Array.from(at).every((x) => Number.isInteger(x) && Math.abs(x) < 2 ** 31))
    throw invalid(`region.${side}`, 'must be three whole numbers: region is { low: [x, y, z], high: [x, y, z] }');
  return Array.from(at);
}

/** Corners of a box; 0 without one. */
function corners(region) {
  if (!region) return [0, 0, 0, 0, 0, 0];
  const low = corner(region, 'low'), high = corner(region, 'high');
  if (low.some((x, k) => x > high[k])) throw invalid('region.low', 'must be at most region.high, along each axis');
  return [...low, ...high];
}

/**
 * SlfOptions as setOptions() of slf_headers.js takes them. Checked before an instance is called: an exception in the middle
 * of a call ends it.
 * @throws {SlfError} INVALID_ARGUMENT
 */
export function checkedOptions(options = {}) {
  if (typeof options !== 'object' || options === null) throw invalid('options', 'must be an object');
  const { region, onProgress } = options, box = corners(region);
  optionalFunction(onProgress, 'onProgress');
  const numbers = [
    whole(options, 'levels', 255), whole(options, 'groups', 255), whole(options, 'maxBytes'), region ? 1 : 0, ...box,
    limit(options, 'maxPoints'), limit(options, 'maxMemory'), limit(options, 'maxWork'), onProgress ? 1 : 0,
    whole(options, 'layers', 255)]; // in the order of web/wasm/slf_wasm.c
  return { numbers, options };
}

const MOST_SIDE = 1024;

/** Side of a function table. */
export function sideOf({ side = 65 } = {}) {
  if (!Number.isInteger(side) || side < 2 || side > MOST_SIDE) throw invalid('side', `must be a whole number, 2 to ${MOST_SIDE}`);
  return side;
}

/** Arrays of a field, by the names that a worker is asked for them with. */
export const ARRAYS = ['positions', 'values', 'octahedral', 'weights', 'meanColours', 'normals', 'centres', 'radii', 'areas',
  'mirrorNormals', 'covariances', 'opacities'];

/** What is wanted of a field of a worker. */
export function checkWanted({ arrays = ARRAYS, functionTable }) {
  const listed = typeof arrays !== 'string' && typeof arrays?.[Symbol.iterator] === 'function';
  if (!listed || ![...arrays].every((name) => ARRAYS.includes(name)))
    throw invalid('arrays', `must be an array of some of ${ARRAYS.join(', ')}`);
  if (functionTable) sideOf(functionTable);
}

/**
 * An address in full, as fetch() has it: of a page its base counts.
 * @param {boolean} own  the caller fetches it: any text is an address then
 */
export function addressOf(url, name = 'url', own = false) {
  const text = typeof url === 'string' ? url : url?.href; // of an URL, a link, the page's location
  if (typeof text !== 'string') throw invalid(name, 'must be an address');
  if (own) return text;
  try {
    return new URL(text, globalThis.document?.baseURI ?? globalThis.location?.href).href;
  } catch (cause) {
    throw invalid(name, `must be an address, which ${text} is not`, cause);
  }
}

export function checkSignal(signal) {
  if (signal && typeof signal.addEventListener !== 'function') throw invalid('signal', 'must be an AbortSignal');
}

export function checkDecoder(decoder) {
  if (decoder && typeof decoder.decodeParts !== 'function')
    throw invalid('decoder', 'must be an SlfDecoder, which SlfDecoder.create() promises');
}

/** Bytes beyond which groups are dropped. */
export function checkKeepBytes(bytes) {
  if (!(typeof bytes === 'number' && bytes >= 0)) throw invalid('keepBytes', 'must be a number of bytes, 0 or more');
}
