// SPDX-License-Identifier: Apache-2.0
// Bytes as text of a page: five characters for four bytes, where base64 takes four for three. None of them is '<', so that
// no text ends the element that it is in, and none has a meaning in a script of type text/plain.

const FIRST = 35, // '#'
  LESS = 60, // '<', for which
  INSTEAD = 120; // 'x' stands

/** @param {Uint8Array} bytes  filled up with zeros to four  @returns {string} */
export function toText(bytes) {
  let text = '';
  for (let i = 0; i < bytes.length; i += 4) {
    let word = [0, 1, 2, 3].reduce((sum, k) => 256 * sum + (bytes[i + k] ?? 0), 0),
      five = '';
    for (let k = 0; k < 5; ++k) {
      const code = FIRST + (word % 85);
      five = String.fromCharCode(code === LESS ? INSTEAD : code) + five;
      word = Math.floor(word / 85);
    }
    text += five;
  }
  return text;
}

/** @returns {Uint8Array} with the zeros that filled them up */
export function fromText(text) {
  const bytes = new Uint8Array((4 * text.length) / 5),
    view = new DataView(bytes.buffer);
  for (let i = 0; i < text.length; i += 5) {
    let word = 0;
    for (let k = 0; k < 5; ++k) {
      const code = text.charCodeAt(i + k);
      word = 85 * word + (code === INSTEAD ? LESS : code) - FIRST;
    }
    view.setUint32((4 * i) / 5, word);
  }
  return bytes;
}
