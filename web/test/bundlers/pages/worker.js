// SPDX-License-Identifier: Apache-2.0
import { SlfWorker } from 'slf-decoder/worker';

const worker = await SlfWorker.create({ /* parts */ });
const { positions, meanColours } = await worker.decode(await (await fetch('/can.slf')).arrayBuffer());
const canvas = document.body.appendChild(Object.assign(document.createElement('canvas'), { width: 400, height: 300 }));
const context = canvas.getContext('2d'), most = positions.reduce((a, b) => Math.max(a, b), 1);
for (let p = 0; p < positions.length / 3; ++p) {
  context.fillStyle = `rgb(${meanColours.subarray(3 * p, 3 * p + 3)})`;
  context.fillRect(300 * positions[3 * p] / most, 299 - 299 * positions[3 * p + 2] / most, 2, 2);
}
window.ready = true;
