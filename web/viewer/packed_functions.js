// SPDX-License-Identifier: Apache-2.0
// Weights and functions as the texels that the pipelines upload; without DOM and WebGL.

const HEADROOM = 1.25; // of the greatest weights of a frame, for those of the frames behind it

/**
 * Weights as shares of the greatest of their function, 16 bit: within 1/100 grey level of the mean.
 * @returns texels [3 L][rows][columns][4 functions], and the greatest weight of every function
 */
export function packWeights(weights, points, components, texels, shared = null) {
  const most = new Float32Array(components);
  for (let i = 0, p = 0; p < points; ++p)
    for (let r = 0; r < components; ++r)
      for (let c = 0; c < 3; ++c, ++i) most[r] = Math.max(most[r], Math.abs(weights[i]));
  const scales = shared ? shared.scalesFor(most) : most;
  const factors = scales.map((s) => (s > 0 ? 32767 / s : 0));
  const out = new Int16Array(3 * Math.ceil(components / 4) * texels * 4);
  for (let i = 0, p = 0; p < points; ++p)
    for (let r = 0; r < components; ++r)
      for (let c = 0; c < 3; ++c, ++i)
        out[((3 * (r >> 2) + c) * texels + p) * 4 + (r & 3)] = Math.round(weights[i] * factors[r]);
  return { texels: out, scales };
}

/**
 * Faces three beside two, a layer for four functions.
 * Functions times the greatest weight of each over 255: a sum with shares of
 * 1 / 32767 is 0 .. 1.
 */
export function packTable(table, scales) {
  const n = table.side,
    width = 3 * n,
    height = 2 * n;
  const out = new Float32Array(table.layers * width * height * 4);
  let from = 0;
  for (let layer = 0; layer < table.layers; ++layer)
    for (let face = 0; face < 6; ++face)
      for (let y = 0; y < n; ++y)
        for (let x = 0; x < n; ++x) {
          const column = (face % 3) * n + x,
            row = Math.floor(face / 3) * n + y;
          const to = ((layer * height + row) * width + column) * 4;
          for (let i = 0; i < 4; ++i, ++from) out[to + i] = (table.data[from] * (scales[4 * layer + i] ?? 0)) / 255;
        }
  return { texels: out, width, height, layers: table.layers, faceSize: n };
}

/** What frames of a light field share: functions are packed and uploaded again only where their weights outgrow them. */
export class FrameFunctions {
  #group = null;
  #table = null;
  #scales = new Float32Array(0);
  #fresh = false; // the texels of this key were not handed out yet
  #key = 0;

  /** Of the frames that follow. @param group  that they are of: functions of others may be different */
  begin(group) {
    if (group === this.#group) return;
    this.#group = group;
    this.#table = null;
    this.#scales = new Float32Array(0);
  }

  /** Scales of at least these maxima, those of the frame before where they are. */
  scalesFor(most) {
    const held = this.#scales.length === most.length && most.every((value, r) => value <= this.#scales[r]);
    if (!held) {
      this.#scales = most.map((value) => HEADROOM * value);
      this.#fresh = true;
      ++this.#key;
    }
    return this.#scales;
  }

  /** As packTable(), with a key; texels are null where the frame before had the same. */
  packed(field, side) {
    this.#table ??= field.functionTable({ side });
    const { layers } = this.#table,
      same = { texels: null, width: 3 * side, height: 2 * side, layers, faceSize: side, key: this.#key };
    if (!this.#fresh) return same;
    this.#fresh = false;
    return { ...packTable(this.#table, this.#scales), key: this.#key };
  }
}
