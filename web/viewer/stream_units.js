// SPDX-License-Identifier: Apache-2.0
// Whether a file that arrives is a light field that moves, by its first bytes. Spec 7.1, 7.13.

const SIGNATURE = [0x8b, 0x53, 0x4c, 0x46, 0x0d, 0x0a, 0x1a, 0x0a];
const FRAME = 11;

/**
 * Whether a stream is one of frames: a frame unit follows the sequence unit (7.13).
 * @returns {boolean|null} null: too few bytes to tell
 */
export function moves(bytes) {
  const at = SIGNATURE.length;
  if (SIGNATURE.some((byte, i) => i < bytes.length && byte !== bytes[i])) return false;
  const next = at < bytes.length ? sequenceEnd(bytes, at) : null;
  if (next === null) return bytes.length > at + 9 ? false : null;
  return next < bytes.length ? bytes[next] === FRAME : null;
}

/** The first byte behind the sequence unit, which has its version before the length (7.1.2); null where that is cut or too long. */
function sequenceEnd(bytes, at) {
  const length = at + 3;
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
