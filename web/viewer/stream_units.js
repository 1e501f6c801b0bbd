// SPDX-License-Identifier: Apache-2.0
// Where units of a stream end (spec 7.1), so that the beginning of a file that is still arriving is
// decoded as far as it goes.

const SIGNATURE = [0x8b, 0x53, 0x4c, 0x46, 0x0d, 0x0a, 0x1a, 0x0a];
const SEQUENCE = 1,
  GEOMETRY = 3,
  COEFFICIENTS = 5,
  FRAME = 11,
  END = 15;

/**
 * @param {Uint8Array} bytes  the beginning of a stream
 * @returns {{foreign: boolean, end: number, pictures: number, complete: boolean}}
 *   foreign: no .slf at all; end: of the last whole unit; pictures: of the last unit up to which every
 *   geometry has coefficients; complete: the end unit is there
 */
export function walkUnits(bytes) {
  const result = { foreign: false, end: 0, pictures: 0, complete: false };
  for (let i = 0; i < Math.min(8, bytes.length); ++i)
    if (bytes[i] !== SIGNATURE[i]) return { ...result, foreign: true };
  let at = SIGNATURE.length;
  while (at < bytes.length && !result.complete) {
    const type = bytes[at],
      end = unitEnd(bytes, at);
    if (end === null || end > bytes.length) break;
    at = end;
    result.end = at;
    if (type === COEFFICIENTS || (type !== GEOMETRY && result.pictures > 0)) result.pictures = at;
    result.complete = type === END;
  }
  return result;
}

/**
 * Whether a stream is one of frames: a frame unit follows the sequence unit (7.13).
 * @returns {boolean|null} null: too few bytes to tell
 */
export function moves(bytes) {
  const at = SIGNATURE.length;
  if (SIGNATURE.some((byte, i) => i < bytes.length && byte !== bytes[i])) return false;
  const next = at < bytes.length ? unitEnd(bytes, at) : null;
  if (next === null) return bytes.length > at + 9 ? false : null;
  return next < bytes.length ? bytes[next] === FRAME : null;
}

/** The first byte behind a unit; null where its length is cut or too long. A sequence unit has its version before the length (7.1.2). */
function unitEnd(bytes, at) {
  const length = at + (bytes[at] === SEQUENCE ? 3 : 1);
  const size = payloadSize(bytes, length);
  return size === null ? null : length + size.digits + size.bytes + 4;
}

/** unit_length: seven bits a byte, least significant first; null where it is cut or too long. */
function payloadSize(bytes, at) {
  let value = 0;
  for (let digits = 0; digits < 6; ++digits) {
    if (at + digits >= bytes.length) return null;
    const byte = bytes[at + digits];
    value += (byte & 0x7f) * 2 ** (7 * digits);
    if (byte < 0x80) return { bytes: value, digits: digits + 1 };
  }
  return null;
}
