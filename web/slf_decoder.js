// SPDX-License-Identifier: Apache-2.0
// What `slf-decoder` gives, and under their older names slf-decoder/stream and slf-decoder/frames (package.json, exports).
// SlfWorker is not here: a bundler would make its worker for every page that decodes.
export { SlfDecoder, SlfError, SlfField, SlfFrames, decoderModule } from './slf.js';
export { SlfStream } from './slf_stream.js';
export { SlfFrameStream, frames } from './slf_frame_stream.js';
