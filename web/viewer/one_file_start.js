// SPDX-License-Identifier: Apache-2.0
// The only code of a one-file page that stands in it as it is: unpacks the rest. The packed bytes are
// three parts, each after its length (4 bytes, least significant first): page, worker, decoder.
addEventListener('DOMContentLoaded', async () => {
  try {
    const text = document.getElementById('slf-code');
    const packed = Uint8Array.from(atob(text.textContent), (c) => c.charCodeAt(0));
    text.remove();
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
    const bytes = new Uint8Array(await new Response(stream).arrayBuffer()),
      parts = [];
    for (let at = 0; at < bytes.length;) {
      const length = new DataView(bytes.buffer).getUint32(at, true);
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
