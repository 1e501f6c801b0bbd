// SPDX-License-Identifier: Apache-2.0
// Types of slf-decoder, slf-decoder/stream and slf-decoder/frames, which are one module.
export * from './slf.js';
export * from './slf_stream.js';
export * from './slf_frame_stream.js';
