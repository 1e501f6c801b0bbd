// SPDX-License-Identifier: Apache-2.0
// How all GLSL of the viewer begins, and how it reads the texels of packed_texels.js.

export const HEAD = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler2DArray;
precision highp usampler2D;
precision highp usampler2DArray;
`;

/** Points as packed_texels.js writes them. */
export const UNPACK = `
uniform vec3 middle;  // of the box, voxels: the origin
vec3 placeOf(uvec4 t) {
  return vec3(t.x & 0x1fffffu, t.x >> 21 | (t.y & 0x3ffu) << 11, t.y >> 10 & 0x1fffffu) - middle;
}
vec3 octahedral(uint code, int bits) {
  uint mask = (1u << bits) - 1u;
  vec2 at = vec2(code & mask, code >> bits & mask) / float(mask >> 1) - 1.0;
  vec3 n = vec3(at, 1.0 - abs(at.x) - abs(at.y));
  if (n.z < 0.0) n.xy = (1.0 - abs(at.yx)) * vec2(at.x < 0.0 ? -1 : 1, at.y < 0.0 ? -1 : 1);
  return normalize(n);
}`;
