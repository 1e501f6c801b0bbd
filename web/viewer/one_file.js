// SPDX-License-Identifier: Apache-2.0
// What the page that `slf html` makes runs once its code is unpacked. `parts` comes from the page's
// own beginning (one_file_start.js): the decoding worker's code and the decoder's bytes.
import { Elements } from './elements.js';
import { FieldLoader } from './field_loader.js';
import { Viewer } from './viewer.js';
import { wordsOf } from './words.js';

export async function start({ worker, wasm }) {
  const address = URL.createObjectURL(new Blob([worker], { type: 'text/javascript' }));
  const page = JSON.parse(document.getElementById('slf-options').textContent);
  const file = document.getElementById('slf-file');
  const bytes = Uint8Array.from(atob(file.textContent), (c) => c.charCodeAt(0));
  file.remove();
  const loader = new FieldLoader({ worker: () => new Worker(address), wasm: wasm.slice().buffer });
  const wanted = new URLSearchParams(location.search).get('lang');
  const words = await wordsOf([wanted, ...navigator.languages].filter(Boolean));
  const elements = new Elements(document, document.body, words);
  window.viewer = new Viewer({ ...page, loader, file: bytes, name: page.title }, { elements });
}
