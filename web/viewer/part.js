// SPDX-License-Identifier: Apache-2.0
// Which part of a file is decoded: what is asked for, as far as a device can have it.
import { ViewerError } from './packed_field.js';

/** A 64th of a surface's points is left: with less there is no picture. */
const MOST_LEVELS_LESS = 3;
/** The first group alone is a mean colour, and of splats no colour at all. */
const LEAST_GROUPS = 2;

/** What was asked for; more than there is, is all. */
export const partOf = (info, { levels, groups, layers }) => ({
  levels: Math.min(levels, info.levels),
  groups: Math.min(groups, info.groups),
  layers: Math.min(layers, info.layers),
});

/**
 * @typedef {object} Budget
 * @property {number} maxMemory  bytes that a decode may take
 * @property {number} maxPoints  that textures hold
 * @property {boolean} mayBeCoarser  a file that takes more is decoded with fewer levels, else refused
 * @property {boolean} groupsFirst  before that with fewer groups of functions
 */

/**
 * The part that was asked for, or the most of it within a budget: as many levels as fit, and of these as many groups.
 * @param {object} info  levels, groups: of the file
 * @param {object} asked  of partOf()
 * @param {Budget} budget
 * @param {(part: object) => {memoryBytes: number, points: number}} preflight
 * @throws {ViewerError} 'too-large'
 */
export function partWithin(info, asked, { maxMemory, maxPoints = Infinity, mayBeCoarser = false, groupsFirst = false }, preflight) {
  const costOf = (part) => preflight({ ...part, maxMemory: Number.MAX_SAFE_INTEGER }),
    fits = ({ memoryBytes, points }) => memoryBytes <= maxMemory && points <= maxPoints;
  const cost = costOf(asked),
    enough = cost.memoryBytes <= maxMemory;
  if (fits(cost)) return asked;
  const most = asked.levels || info.levels,
    groups = asked.groups || info.groups,
    least = Math.max(1, info.levels - MOST_LEVELS_LESS);
  for (let levels = most; mayBeCoarser && levels >= least; --levels) {
    const part = { ...asked, levels };
    if (levels < most && fits(costOf(part))) return part;
    const fewer = groupsFirst ? greatest(LEAST_GROUPS, groups - 1, (some) => fits(costOf({ ...part, groups: some }))) : 0;
    if (fewer > 0) return { ...part, groups: fewer };
  }
  if (enough) return asked; // no part has so few points: what draws says so
  throw new ViewerError('too-large', `Decoding this file takes ${Math.ceil(cost.memoryBytes / 2 ** 20)} MiB.`);
}

/** The greatest number from `low` to `high` that fits, where all below it do; 0: none. */
function greatest(low, high, fits) {
  let found = 0;
  while (low <= high) {
    const middle = (low + high) >> 1;
    if (fits(middle)) {
      found = middle;
      low = middle + 1;
    } else {
      high = middle - 1;
    }
  }
  return found;
}
