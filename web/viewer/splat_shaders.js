// SPDX-License-Identifier: Apache-2.0
// GLSL of Gaussian splats, spec annex E.6. Lengths are voxels, colours 0 .. 1 and more, images have their first row at
// the bottom. The constants are those of lightfield/render/gaussian_cloud.h.
import { TRANSFERS } from './shaders.js';
import { HEAD, UNPACK } from './texel_shaders.js';

export const SPLAT_VERTEX = `${HEAD}${UNPACK}
uniform usampler2D places, tails;  // of packed_texels.js
uniform sampler2D colours;
uniform usampler2D order;  // from the farthest to the nearest
uniform mat3 rotation;     // world to camera: right, down, forward
uniform vec3 eye;
uniform vec2 focal, centre, size;  // pixels; rows upwards
uniform int first;         // of this draw
uniform float thinning;    // every how many-th splat is drawn
uniform float nearest;     // depth before which nothing is drawn
flat out vec2 at;          // of the splat's centre, pixels
flat out vec4 ellipse;     // a, b, c of a x^2 + 2 b x y + c y^2, squared deviations; opacity
flat out vec2 ends;        // squared deviations at which it ends; share of its inverse depth in that of the nearest
flat out vec3 colour;

const float FILTER = 0.3, FRUSTUM_SHARE = 1.3;

void main() {
  gl_Position = vec4(2, 2, 0, 1);  // outside, until it is known to show
  int turn = first + (gl_VertexID >> 2), columns = textureSize(places, 0).x;
  int point = int(texelFetch(order, ivec2(turn % columns, turn / columns), 0).x);
  ivec2 texel = ivec2(point % columns, point / columns);
  uvec4 splat = texelFetch(places, texel, 0);
  vec3 p = rotation * (placeOf(splat) - eye);
  if (!(p.z > nearest)) return;
  uvec2 tail = texelFetch(tails, texel, 0).xy;
  float opacity = unpackHalf2x16(tail.y).x, ending = 2.0 * log(255.0 * opacity);
  if (!(opacity > 0.0 && ending > 0.0)) return;

  float z = 1.0 / p.z;
  vec2 limit = FRUSTUM_SHARE * 0.5 * size / abs(focal), tangent = clamp(p.xy * z, -limit, limit);
  // Rows of the derivative of the projection, in world axes, along the triangle L: the covariance is L L'.
  vec2 one = unpackHalf2x16(splat.z), two = unpackHalf2x16(splat.w), three = unpackHalf2x16(tail.x);
  mat3 triangle = mat3(one, two.y, 0, two.x, three.y, 0, 0, three.x);
  vec3 ju = focal.x * z * (vec3(1, 0, -tangent.x) * rotation) * triangle;
  vec3 jv = focal.y * z * (vec3(0, 1, -tangent.y) * rotation) * triangle;
  float uu = thinning * dot(ju, ju) + FILTER, uv = thinning * dot(ju, jv), vv = thinning * dot(jv, jv) + FILTER;
  float inverse = 1.0 / (uu * vv - uv * uv);
  if (!(inverse > 0.0 && inverse < 1e30)) return;
  at = centre + focal * p.xy * z;
  vec2 box = sqrt(ending * vec2(uu, vv));
  if (any(lessThan(at + box, vec2(0))) || any(greaterThan(at - box, size))) return;
  ellipse = vec4(vec3(vv, -uv, uu) * inverse, opacity);
  ends = vec2(ending, nearest * z);
  colour = texelFetch(colours, texel, 0).rgb;

  // A rectangle along the axes of the ellipse.
  float mean = 0.5 * (uu + vv), differ = 0.5 * (uu - vv), root = length(vec2(differ, uv));
  vec2 axis = root > 1e-6 * mean ? normalize(differ > 0.0 ? vec2(root + differ, uv) : vec2(uv, root - differ)) : vec2(1, 0);
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1 & 1) * 2.0 - 1.0;
  corner *= sqrt(ending * vec2(mean + root, max(mean - root, 0.0))) + 0.01;
  gl_Position = vec4((at + corner.x * axis + corner.y * vec2(-axis.y, axis.x)) / size * 2.0 - 1.0, 0, 1);
}`;

/** Colour and share of what is behind that it hides; inverse depths, blended alike. */
export const SPLAT_FRAGMENT = `${HEAD}
flat in vec2 at;
flat in vec4 ellipse;
flat in vec2 ends;
flat in vec3 colour;
layout(location = 0) out vec4 blended;
layout(location = 1) out vec4 depth;

void main() {
  vec2 d = gl_FragCoord.xy - at;
  float square = d.x * (ellipse.x * d.x + 2.0 * ellipse.y * d.y) + ellipse.z * d.y * d.y;
  if (square >= ends.x) discard;
  float hides = min(0.99, ellipse.w * exp(-0.5 * max(square, 0.0)));
  blended = vec4(hides * colour, hides);
  depth = vec4(hides * ends.y, 0, 0, hides);
}`;

/** The sum over what is there. */
export const SPLAT_RESOLVE_FRAGMENT = `${HEAD}
uniform sampler2D blended, depth;
uniform vec4 viewport;            // of the target; the sums may be coarser
uniform float nearest, exposure;  // 1 / the greatest inverse depth; factor in linear light
uniform bool toLinear;            // transfer of the target; that of splats is the display's
uniform vec2 depthRange;          // target depth = x + y * inverse depth
out vec4 colour;
${TRANSFERS}
void main() {
  vec2 place = (gl_FragCoord.xy - viewport.xy) / viewport.zw;
  colour = texture(blended, place);
  if (!(colour.a > 0.0)) discard;
  if (exposure != 1.0 || toLinear) {
    vec3 c = min(exposure * fromDisplay(colour.rgb / colour.a), 1.0);
    colour.rgb = colour.a * (toLinear ? c : toDisplay(c));
  }
  gl_FragDepth = clamp(depthRange.x + depthRange.y * texture(depth, place).x / (colour.a * nearest), 0.0, 1.0);
}`;
