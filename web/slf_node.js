// SPDX-License-Identifier: Apache-2.0
// What node runs in place of slf.js and slf_stream.js (package.json, exports): files are read from the disk.
import { readFile } from 'node:fs/promises';
import { files } from './slf_instance.js';

files.read = readFile;

export * from './slf.js';
export { SlfStream } from './slf_stream.js';
export { SlfFrameStream, frames } from './slf_frame_stream.js';
