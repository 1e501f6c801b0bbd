// Holds a file's bytes and decodes them, whole or as far as they have come, off the page's thread.
// Messages: {wasm}, {append}, {reset}, {decode: options, id}; answers: {ready}, {id, packed, info} or {id, error}.
import { SlfDecoder } from '../slf.js';
import { answer } from './decode_session.js';

answer(self, (wasm) => SlfDecoder.create(wasm ? { wasm } : {}));
self.postMessage({ ready: true });
