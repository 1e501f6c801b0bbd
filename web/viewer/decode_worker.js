// SPDX-License-Identifier: Apache-2.0
// Holds a file's bytes and decodes them, whole or as far as they have come, off the page's thread.
// Messages: {wasm}, {append}, {reset}, {decode: options, id}, {give, id}, {frames: options, id}, {frame: place, id};
// answers: {ready}, {id, packed, info, ...} or {id, error}, {list} of frames that have arrived.
import { SlfDecoder } from '../slf.js';
import { answer } from './decode_session.js';
import { FrameSession } from './frame_session.js';

answer(self, (wasm) => SlfDecoder.create(wasm ? { wasm } : {}), FrameSession);
self.postMessage({ ready: true });
