// SPDX-License-Identifier: Apache-2.0
// Weights and functions as the texels that the pipelines upload; without DOM and WebGL.
//
// A weight is a share of the greatest of its function, in a byte. Functions whose bytes would show have another byte, of
// what the first leaves over. Words of four functions, R, G, B of layer 0, then of layer 1; then a word for each function
// with a second byte: that of R, G, B. A texel has four words.
import { toSignedHalf } from './packed_texels.js';

const HEADROOM = 1.25, // of the greatest weights of a frame, for those of the frames behind it
  SUFFICIENT = 1 / 8; // grey level, r.m.s. of all that bytes leave over: 66 dB
export const MOST_SHARE = 127 * 256; // of both bytes

/** Functions in the order of what bytes leave over of them, and how many have a second byte. */
function orderOf(scales, table) {
  const left = Array.from(scales, (scale, r) => ({ r, square: (scale / 127) ** 2 / 12 * meanSquareOf(table, r) }));
  left.sort((a, b) => b.square - a.square || a.r - b.r);
  let fine = left.length;
  for (let rest = 0; fine > 0 && (rest += left[fine - 1].square) <= SUFFICIENT ** 2;) --fine;
  return { order: left.map(({ r }) => r), fine };
}

function meanSquareOf({ data, side }, r) {
  const count = 6 * side * side;
  let sum = 0;
  for (let i = 0, at = 4 * count * (r >> 2) + (r & 3); i < count; ++i, at += 4) sum += data[at] ** 2;
  return sum / count;
}

const BLOCK = 1 << 14; // points whose weights are floats at a time

/** use(weights, first, count) for some points at a time. */
function eachBlock(field, use) {
  const block = new Float32Array(3 * field.functions * Math.min(BLOCK, field.points));
  for (let first = 0; first < field.points; first += BLOCK) {
    const count = Math.min(BLOCK, field.points - first);
    use(field.weights(block, first, count), first, count);
  }
}

/** The greatest weight of every function. */
function greatestOf(field) {
  const most = new Float32Array(field.functions);
  eachBlock(field, (weights, _, count) => {
    for (let i = 0, p = 0; p < count; ++p)
      for (let r = 0; r < most.length; ++r)
        for (let c = 0; c < 3; ++c, ++i) {
          const size = Math.abs(weights[i]);
          if (size > most[r]) most[r] = size;
        }
  });
  return most;
}

/**
 * @param {number} texels  columns times rows
 * @param {FrameFunctions|null} shared  what frames of one light field have in common
 * @returns weights [weightLayers][texels][4] words; fine: functions with a second byte; functions: of packTable()
 */
export function packFunctions(field, texels, side, shared = null) {
  const { scales, order, fine, functions } = (shared ?? new FrameFunctions(1)).of(field, side, greatestOf(field)),
    layers = Math.ceil(field.functions / 4),
    weightLayers = Math.max(1, Math.ceil((3 * layers + fine) / 4)),
    weights = new Uint32Array(4 * weightLayers * texels),
    bytes = new Int8Array(weights.buffer);
  eachBlock(field, (block, first, count) => {
    order.forEach((r, turn) => {
      const factor = scales[r] > 0 ? MOST_SHARE / scales[r] : 0;
      for (let c = 0; c < 3; ++c) {
        const upper = byteAt(texels, 3 * (turn >> 2) + c, turn & 3) + 16 * first,
          lower = turn < fine ? byteAt(texels, 3 * layers + turn, c) + 16 * first : -1;
        for (let p = 0, from = 3 * r + c; p < count; ++p, from += 3 * order.length) {
          const share = Math.round(block[from] * factor),
            most = (share + 128) >> 8;
          bytes[upper + 16 * p] = most;
          if (lower >= 0) bytes[lower + 16 * p] = share - 256 * most;
        }
      }
    });
  });
  return { weights, layers, weightLayers, fine, functions };
}

/** Where the byte of a word of the first point is. */
const byteAt = (texels, word, byte) => ((word >> 2) * texels * 4 + (word & 3)) * 4 + byte;

/**
 * Faces three beside two, a layer for four functions, half floats.
 * Functions times the greatest weight of each over 255: a sum with shares of 1 is 0 .. 1.
 */
function packTable(table, scales, order) {
  const n = table.side,
    width = 3 * n,
    height = 2 * n,
    face = n * n * 4;
  const out = new Uint16Array(table.layers * width * height * 4);
  order.forEach((r, turn) => {
    const factor = scales[r] / 255;
    let from = (r >> 2) * 6 * face + (r & 3);
    for (let row = 0; row < 6 * n; ++row) {
      const f = Math.floor(row / n),
        line = (turn >> 2) * height + Math.floor(f / 3) * n + (row % n);
      let to = (line * width + (f % 3) * n) * 4 + (turn & 3);
      for (let x = 0; x < n; ++x, from += 4, to += 4) out[to] = toSignedHalf(table.data[from] * factor);
    }
  });
  return { texels: out, width, height, layers: table.layers, faceSize: n };
}

/** What frames of a light field share: functions are packed and uploaded again only where their weights outgrow them. */
export class FrameFunctions {
  #headroom;
  #group = null;
  #table = null;
  #shares = null; // scales, order, fine
  #key = 0;

  constructor(headroom = HEADROOM) {
    this.#headroom = headroom;
  }

  /** Of the frames that follow. @param group  that they are of: functions of others may be different */
  begin(group) {
    if (group === this.#group) return;
    this.#group = group;
    this.#table = this.#shares = null;
  }

  /**
   * Scales of at least these maxima, those of the frame before where they are, and the functions with a key; their texels
   * are null where the frame before had the same.
   */
  of(field, side, most) {
    this.#table ??= field.functionTable({ side });
    const held = this.#shares?.scales.length === most.length && most.every((value, r) => value <= this.#shares.scales[r]);
    if (held) return { ...this.#shares, functions: { texels: null, ...this.#sizes(side), key: this.#key } };
    const scales = most.map((value) => this.#headroom * value);
    this.#shares = { scales, ...orderOf(scales, this.#table) };
    return { ...this.#shares, functions: { ...packTable(this.#table, scales, this.#shares.order), key: ++this.#key } };
  }

  #sizes(side) {
    return { width: 3 * side, height: 2 * side, layers: this.#table.layers, faceSize: side };
  }
}
