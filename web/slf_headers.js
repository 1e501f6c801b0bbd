// SPDX-License-Identifier: Apache-2.0
// What is asked of a decode, and what headers say, in the numbers of web/wasm/slf_wasm.c.
import { checkedOptions } from './slf_arguments.js';

const UP = ['+x', '-x', '+y', '-y', '+z', '-z', 'unknown'];
export const DIRECTIONS = ['world', 'reflected'];
export const TRANSFERS = ['display', 'linear'];
const PROFILES = ['main', 'draco', 'texture'];

/** @param checked  of checkedOptions() */
export function setOptions(instance, { numbers, options }) {
  instance.setNumbers(numbers);
  instance.wasm.slfw_set_options();
  instance.onProgress = (fraction) => (options.onProgress(fraction) === false ? 1 : 0);
}

export function readInfo(instance, stream) {
  const w = instance.wasm;
  if (w.slfw_info(stream) !== 0) instance.fail();
  const [format, bytes, points, slices, groups, levels, functions, components, normalBits, x, y, z, step, metres, up,
    leftHanded, hasBasis, basis, directions, transfer, gammaMin, gammaMax, complete, pairs, profile, hasIndex, layers,
    splats] = instance.numbers(28);
  const text = (i, value) => instance.text(w.slfw_metadata(stream, i, value));
  // A key may be "__proto__", which an assignment would lose.
  const metadata = Object.fromEntries(Array.from({ length: pairs }, (_, i) => [text(i, 0), text(i, 1)]));
  return {
    version: `${format >>> 16}.${format & 0xffff}`, profile: PROFILES[profile], bytes, points, functions, components,
    bits: levels, levels, slices, groups, layers, normalBits, grid: { origin: [x, y, z], step, bits: levels },
    metresPerUnit: metres, up: UP[up], rightHanded: leftHanded === 0, hasBasis: hasBasis !== 0,
    basis: basis === 0 ? 'bspline' : 'harmonics', directions: DIRECTIONS[directions], transfer: TRANSFERS[transfer],
    gamma: [gammaMin, gammaMax], complete: complete !== 0, hasIndex: hasIndex !== 0,
    hasSplats: splats !== 0, metadata,
  };
}

const UNLIMITED = checkedOptions({ maxPoints: Infinity, maxMemory: Infinity, maxWork: Infinity });

/** The same, and what a decode of all of it takes. */
export function readCost(instance, stream) {
  const info = readInfo(instance, stream);
  setOptions(instance, UNLIMITED); // that is said, whatever may be allowed
  info.decodeBytes = preflight(instance, stream).memoryBytes;
  return info;
}

export function preflight(instance, stream) {
  if (instance.wasm.slfw_preflight(stream) !== 0) instance.fail();
  const [components, points, readBytes, fieldBytes, memoryBytes] = instance.numbers(5);
  return { components, points, readBytes, fieldBytes, memoryBytes };
}
