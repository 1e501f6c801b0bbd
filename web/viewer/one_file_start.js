// SPDX-License-Identifier: Apache-2.0
// The only code of a one-file page that stands in it as it is: unpacks the rest. The packed bytes stand after the
// length of what they pack: three parts, each after its own (4 bytes, least significant first): page, worker, decoder.
import { fromText } from './base85.js';
import { unpack } from './lzma.js';

addEventListener('DOMContentLoaded', async () => {
  try {
    const text = document.getElementById('slf-code');
    const packed = fromText(text.textContent);
    text.remove();
    const lengthAt = (bytes, at) => new DataView(bytes.buffer).getUint32(at, true);
    const bytes = unpack(packed.subarray(4), lengthAt(packed, 0)),
      parts = [];
    for (let at = 0; at < bytes.length;) {
      const length = lengthAt(bytes, at);
      parts.push(bytes.subarray(at + 4, at + 4 + length));
      at += 4 + length;
    }
    const script = document.createElement('script'),
      utf8 = new TextDecoder();
    script.textContent = utf8.decode(parts[0]);
    document.head.append(script);
    await slfPage.start({ worker: utf8.decode(parts[1]), wasm: parts[2] });
  } catch (error) {
    const problem = document.getElementById('problem');
    problem.hidden = false;
    problem.querySelector('h2').textContent = 'This browser is too old for this page';
    problem.querySelector('p').textContent = String(error);
  }
});
