// SPDX-License-Identifier: Apache-2.0
// Splats from the farthest to the nearest along a view: a counting sort of 16 bits, twice, over the bits of a float,
// so that the order is that of the C++ renderer. In slices of time, for what is too much for a frame.

import { placeOf } from './packed_texels.js';

const AT_ONCE = 100_000, // splats that are sorted within a frame: some milliseconds
  SLICE = 1 << 14, // splats between looks at the clock
  BUDGET_MS = 4; // of a frame

export class SplatOrder {
  /** @param packed  of packSplats(): its places are kept */
  constructor({ places, points, middle, nearest }) {
    Object.assign(this, { places, points, middle, nearest });
    this.order = new Uint32Array(points);
    this.other = new Uint32Array(points);
    this.half = new Uint32Array(points);
    this.keys = new Uint32Array(points);
    this.depths = new Float32Array(this.keys.buffer); // positive floats are in the order of their bits
    this.counts = new Uint32Array(1 << 16);
    this.count = 0; // of those in `order`
    this.made = this.asked = null; // views that it is of, and that is being sorted
    this.work = null;
  }

  /** Whether `order` is that of the view that was asked for last. */
  get settled() {
    return this.work === null && this.made === this.asked;
  }

  /**
   * Works towards a view.
   * @param {number[]} eye  voxels  @param {number[]} forward  of length 1
   * @param {number} drawn  splats, evenly of all
   * @param {boolean} patient  it may take several calls, until `settled`
   * @returns {boolean} whether `order` is another than before
   */
  towards(eye, forward, drawn, patient = false) {
    const key = `${eye} ${forward} ${drawn}`;
    this.asked = key;
    const atOnce = !patient || drawn <= AT_ONCE;
    if (atOnce && this.working !== key) this.work = null; // that of another view
    if (this.work === null) {
      if (this.made === key) return false;
      this.working = key;
      this.work = this.sort(eye, forward, drawn);
    }
    const end = atOnce ? Infinity : performance.now() + BUDGET_MS;
    while (!this.work.next().done) if (performance.now() > end) return false;
    this.work = null;
    this.made = this.working;
    return true;
  }

  /** Stable; splats of one depth are drawn with the first of the file before the others. */
  *sort(eye, forward, drawn) {
    const { points, middle, keys, depths, counts } = this,
      offset = -(eye[0] * forward[0] + eye[1] * forward[1] + eye[2] * forward[2]),
      thinning = points / drawn;
    const found = this.other,
      half = this.half;
    let count = 0;
    for (let i = 0; i < drawn; ++i) {
      const p = Math.floor(i * thinning),
        [x, y, z] = placeOf(this, p),
        depth = (x - middle[0]) * forward[0] + (y - middle[1]) * forward[1] + (z - middle[2]) * forward[2] + offset;
      if (depth > this.nearest) {
        depths[p] = depth;
        found[count++] = p;
      }
      if (i % SLICE === SLICE - 1) yield;
    }
    yield* scatter(found, half, count, keys, 0, counts);
    yield* scatter(half, found, count, keys, 16, counts);
    found.subarray(0, count).reverse();
    [this.order, this.other, this.count] = [found, this.order, count];
  }
}

/** A pass over sixteen bits of the keys of `from`. */
function* scatter(from, to, count, keys, shift, counts) {
  counts.fill(0);
  for (let i = 0; i < count; ++i) {
    ++counts[(keys[from[i]] >>> shift) & 0xffff];
    if (i % SLICE === SLICE - 1) yield;
  }
  let sum = 0;
  for (let i = 0; i < counts.length; ++i) {
    const own = counts[i];
    counts[i] = sum;
    sum += own;
  }
  for (let i = 0; i < count; ++i) {
    const p = from[i];
    to[counts[(keys[p] >>> shift) & 0xffff]++] = p;
    if (i % SLICE === SLICE - 1) yield;
  }
}
