// What the page that `slf html` makes runs once its code is unpacked. `parts` comes from the page's
// own beginning (one_file_start.js): the decoding worker's code and the decoder's bytes.
import { FieldLoader } from './field_loader.js';
import { Viewer } from './viewer.js';

export function start({ worker, wasm }) {
  const address = URL.createObjectURL(new Blob([worker], { type: 'text/javascript' }));
  const page = JSON.parse(document.getElementById('slf-options').textContent);
  const file = document.getElementById('slf-file');
  const bytes = Uint8Array.from(atob(file.textContent), (c) => c.charCodeAt(0));
  file.remove();
  const loader = new FieldLoader({ worker: () => new Worker(address), wasm: wasm.slice().buffer });
  window.viewer = new Viewer({ ...page, loader, file: bytes, name: page.title });
}
