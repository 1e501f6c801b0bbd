// SPDX-License-Identifier: Apache-2.0
// What a device says of itself, and how much memory a decode may take there.

const LARGEST_HANDHELD = 1024; // CSS pixels across: a large tablet
const MIB_PER_GIB = { desk: 256, hand: 128 }; // a page takes half as much again for its textures
const UNTOLD = { desk: 2048, hand: 384 }; // MiB, where browsers tell nothing
const MOST = { desk: 2048, hand: 512 },
  LEAST = { desk: 128, hand: 0 };

/**
 * @typedef {object} Device
 * @property {number} gibibytes  memory, as far as browsers tell (0.25 to 32); 0: they do not
 * @property {boolean} mobile  what the browser calls itself
 * @property {boolean} coarse  fingers are what points
 * @property {number} across  CSS pixels of the screen's shorter side
 */

/** @returns {Device} */
export function deviceFacts({ navigator, screen, matchMedia } = globalThis) {
  return {
    gibibytes: navigator?.deviceMemory ?? 0,
    mobile: navigator?.userAgentData?.mobile === true,
    coarse: matchMedia?.('(pointer: coarse)').matches === true,
    across: screen ? Math.min(screen.width, screen.height) : Infinity,
  };
}

/** A phone or a tablet, whose system ends pages that take much. @param {Device} device */
export const isHandheld = ({ mobile, coarse, across }) => mobile || (coarse && across <= LARGEST_HANDHELD);

/** MiB that a decode may take: a quarter of the device's memory, of a phone's or a tablet's an eighth. @param {Device} device */
export function memoryOfDevice(device = deviceFacts()) {
  const kind = isHandheld(device) ? 'hand' : 'desk';
  if (!(device.gibibytes > 0)) return UNTOLD[kind];
  return Math.min(MOST[kind], Math.max(LEAST[kind], MIB_PER_GIB[kind] * device.gibibytes));
}
