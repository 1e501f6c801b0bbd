// SPDX-License-Identifier: Apache-2.0
// What node runs in place of slf_decoder.js (package.json, exports): files are read from the disk.
import { readFile } from 'node:fs/promises';
import { files } from './slf_instance.js';

files.read = readFile;

export * from './slf_decoder.js';
