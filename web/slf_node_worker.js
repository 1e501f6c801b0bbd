// SPDX-License-Identifier: Apache-2.0
// What node runs in place of slf_worker.js (package.json, exports): files are read from the disk.
import './slf_node.js';

export { SlfWorker } from './slf_worker.js';
