// SPDX-License-Identifier: Apache-2.0
// GLSL that leaves out what of discs is behind others. It adds nothing to sums of colours, and nothing to the coverage of
// pixels (E.5) that the disc in front covers wholly: depths say so in their last bit. Whole discs are left out by blocks of
// pixels, in the vertex shader; what is left of them by the depth test, whose depths are those of occluders.
import { HEAD } from './texel_shaders.js';

export const BLOCK = 4; // pixels of a side
const MOST_BLOCKS = 4; // of a side that a vertex looks at: larger discs are drawn

/** The depth of what covers a pixel wholly; else 0. */
export const OCCLUDER_FRAGMENT = `${HEAD}
uniform sampler2D depth;
void main() {
  float front = texelFetch(depth, ivec2(gl_FragCoord.xy), 0).x;
  bool covers = (floatBitsToUint(front) & 1u) == 1u && front < 1.0;  // at 1 it may have been nearer
  gl_FragDepth = covers ? front : 0.0;
}`;

/** The least of a block of pixels. */
export const BLOCK_FRAGMENT = `${HEAD}
uniform sampler2D occluders;
void main() {
  ivec2 from = ivec2(gl_FragCoord.xy) * ${BLOCK}, last = textureSize(occluders, 0) - 1;
  float least = 1.0;
  for (int i = 0; i < ${BLOCK * BLOCK} && least > 0.0; ++i)
    least = min(least, texelFetch(occluders, min(from + ivec2(i % ${BLOCK}, i / ${BLOCK}), last), 0).x);
  gl_FragDepth = least;
}`;

/** hidden(low, high, depth): a box of pixels is wholly covered by what is before `depth`. */
export const HIDDEN = `
uniform sampler2D blocks;
bool hidden(vec2 low, vec2 high, float depth) {
  ivec2 last = textureSize(blocks, 0) - 1;
  ivec2 from = clamp(ivec2(low) / ${BLOCK}, ivec2(0), last), to = clamp(ivec2(high) / ${BLOCK}, ivec2(0), last);
  if (any(greaterThan(to - from, ivec2(${MOST_BLOCKS - 1})))) return false;
  for (int y = from.y; y <= to.y; ++y)
    for (int x = from.x; x <= to.x; ++x)
      if (texelFetch(blocks, ivec2(x, y), 0).x < depth) return false;
  return true;
}
`;
