// SPDX-License-Identifier: Apache-2.0
// LZMA without a header, as `xz --format=raw --lzma1=lc=4,lp=0,pb=0` writes it (Igor Pavlov's specification, public
// domain). A one-file page unpacks its code by it: browsers' own DecompressionStream takes a sixth more bytes.

const STATES = 12,
  SLOT_BITS = 6,
  LENGTHS = 2 + 8 + 8 + 256; // contexts of a length: two choices, low, middle, high
// Where contexts of each kind begin.
const MATCH = 0,
  REPEAT = MATCH + STATES,
  FIRST = REPEAT + STATES,
  SECOND = FIRST + STATES,
  THIRD = SECOND + STATES,
  LONG = THIRD + STATES,
  SLOT = LONG + STATES,
  SPECIAL = SLOT + (4 << SLOT_BITS),
  ALIGN = SPECIAL + 115,
  LENGTH = ALIGN + 16,
  REPEAT_LENGTH = LENGTH + LENGTHS,
  LITERAL = REPEAT_LENGTH + LENGTHS;
const CONTEXT_BITS = 4, // of the byte before, that choose a literal's contexts
  LITERAL_CONTEXTS = 0x300;

/** @param {Uint8Array} from  sound: it comes with this code  @param {number} size  bytes that it stands for */
export function unpack(from, size) {
  const out = new Uint8Array(size),
    contexts = new Uint16Array(LITERAL + (LITERAL_CONTEXTS << CONTEXT_BITS)).fill(1024);
  const coder = new Uint32Array([2 ** 32 - 1, 0]), // range and code: engines box large numbers that functions share
    repeats = [0, 0, 0, 0]; // distances - 1, the last first
  let at = 1,
    done = 0,
    state = 0;
  const renew = () => {
    coder[0] <<= 8;
    coder[1] = (coder[1] << 8) | from[at++];
  };
  const bit = (i) => {
    const p = contexts[i],
      bound = (coder[0] >>> 11) * p;
    if (coder[1] < bound) {
      coder[0] = bound;
      contexts[i] = p + ((2048 - p) >> 5);
      if (bound < 1 << 24) renew();
      return 0;
    }
    coder[0] -= bound;
    coder[1] -= bound;
    contexts[i] = p - (p >> 5);
    if (coder[0] < 1 << 24) renew();
    return 1;
  };
  const even = () => { // a bit that is as likely 0 as 1
    coder[0] >>>= 1;
    const one = Number(coder[1] >= coder[0]);
    coder[1] -= one * coder[0];
    if (coder[0] < 1 << 24) renew();
    return one;
  };
  const tree = (base, bits, node = 1) => {
    for (let i = 0; i < bits; ++i) node = 2 * node + bit(base + node);
    return node - (1 << bits);
  };
  const reversed = (base, bits) => {
    let node = 1,
      value = 0;
    for (let i = 0, b; i < bits; ++i, node = 2 * node + b) value |= (b = bit(base + node)) << i;
    return value;
  };
  const length = (base) => {
    if (!bit(base)) return tree(base + 2, 3);
    return bit(base + 1) ? 16 + tree(base + 18, 8) : 8 + tree(base + 10, 3);
  };
  const distance = (slot) => {
    if (slot < 4) return slot;
    const bits = (slot >> 1) - 1,
      high = (2 | (slot & 1)) * 2 ** bits;
    if (slot < 14) return high + reversed(SPECIAL + high - slot, bits);
    let middle = 0;
    for (let i = 4; i < bits; ++i) middle = 2 * middle + even();
    return high + 16 * middle + reversed(ALIGN, 4);
  };
  const literal = () => {
    const base = LITERAL + LITERAL_CONTEXTS * ((done ? out[done - 1] : 0) >> (8 - CONTEXT_BITS));
    let node = 1;
    if (state > 6) // after a match: what stood there is what this is not
      for (let like = out[done - repeats[0] - 1], same = true; same && node < 256; like <<= 1) {
        const expected = (like >> 7) & 1,
          b = bit(base + ((1 + expected) << 8) + node);
        node = 2 * node + b;
        same = b === expected;
      }
    while (node < 256) node = 2 * node + bit(base + node);
    out[done++] = node;
    state = state < 4 ? 0 : state < 10 ? state - 3 : state - 6;
  };
  const copy = (count) => {
    for (; count > 0 && done < size; --count, ++done) out[done] = out[done - repeats[0] - 1];
  };
  for (; at < 5; ++at) coder[1] = (coder[1] << 8) | from[at];
  while (done < size) {
    const before = state > 6;
    if (!bit(MATCH + state)) literal();
    else if (!bit(REPEAT + state)) {
      const more = length(LENGTH);
      repeats.unshift(distance(tree(SLOT + (Math.min(more, 3) << SLOT_BITS), SLOT_BITS)));
      repeats.pop();
      copy(2 + more);
      state = before ? 10 : 7;
    } else {
      let which = 0,
        short = false;
      if (bit(FIRST + state)) which = bit(SECOND + state) ? 2 + bit(THIRD + state) : 1;
      else short = !bit(LONG + state);
      repeats.unshift(...repeats.splice(which, 1));
      copy(short ? 1 : 2 + length(REPEAT_LENGTH));
      state = before ? 11 : short ? 9 : 8;
    }
  }
  return out;
}
