// SPDX-License-Identifier: Apache-2.0
// GLSL of the reference reconstruction, spec annex E. Lengths are voxels, colours 0 .. 1, images have
// their first row at the bottom, as WebGL has it. The constants are those of lightfield/render/reference_kernel.h.

import { HIDDEN } from './occluder_shaders.js';
import { HEAD, UNPACK } from './texel_shaders.js';

/** Of colours: spec 6.5. */
export const TRANSFERS = `
vec3 toDisplay(vec3 c) {
  return mix(12.92 * c, 1.055 * pow(max(c, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}
vec3 fromDisplay(vec3 c) {
  return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}`;

/** Every pixel of the target once: a triangle that holds all of it. */
export const SCREEN_VERTEX = `${HEAD}
void main() {
  gl_Position = vec4(vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0), 0.0, 1.0);
}`;

/** One fragment a point: its colour along the direction to the eye. Spec 6.4, 6.7. */
export const COLOUR_FRAGMENT = `${HEAD}${UNPACK}
uniform usampler2D places;
uniform usampler2D directions;    // normal that mirrors the direction; all ones: none, as of directions of the world
uniform sampler2D means;          // mean colour
uniform usampler2DArray weights;  // words of packed_functions.js
uniform sampler2DArray functions; // layer l: functions 4 l .. 4 l + 3, scaled to the weights
uniform vec3 eye;
uniform vec2 gamma;
uniform int points, layers;
uniform int fine;        // functions with a second byte
uniform float faceSize;  // texels along a face of the table
uniform bool meanOnly, mirrored, rooted;
uniform float brightest;  // splats are not clamped from above: E.6
out vec4 colour;

/** Where direction w stands in the table: faces lie three beside two. */
vec2 tablePlace(vec3 w) {
  vec3 a = abs(w);
  int face;
  vec2 st;
  if (a.x >= a.y && a.x >= a.z) {
    face = w.x < 0.0 ? 1 : 0;
    st = vec2(w.x < 0.0 ? w.z : -w.z, -w.y) / a.x;
  } else if (a.y >= a.z) {
    face = w.y < 0.0 ? 3 : 2;
    st = vec2(w.x, w.y < 0.0 ? -w.z : w.z) / a.y;
  } else {
    face = w.z < 0.0 ? 5 : 4;
    st = vec2(w.z < 0.0 ? -w.x : w.x, -w.y) / a.z;
  }
  vec2 texel = (st * 0.5 + 0.5) * (faceSize - 1.0) + 0.5;
  return (texel + faceSize * vec2(face % 3, face / 3)) / (faceSize * vec2(3, 2));
}

/** The direction to the eye in the point's frame, gamma within what cameras saw. */
vec3 direction(vec3 place, uint mirror) {
  vec3 to = eye - place;
  vec3 w = dot(to, to) > 0.0 ? normalize(to) : vec3(1, 0, 0);
  if (mirror != 0xffffffffu) {
    vec3 n = octahedral(mirror, 16);
    w = 2.0 * dot(n, w) * n - w;
  }
  float g = clamp(w.z, gamma.x, gamma.y);
  if (g == w.z) return w;
  float across = length(w.xy), rest = sqrt(max(0.0, 1.0 - g * g));
  return across > 0.0 ? vec3(w.xy * (rest / across), g) : vec3(rest, 0, g);
}

ivec2 at;
int words = 0;
uvec4 texel;
/** The next four bytes of weights, as numbers. */
vec4 next() {
  texel = (words & 3) == 0 ? texelFetch(weights, ivec3(at, words >> 2), 0) : texel.yzwx;
  ++words;
  return vec4(ivec4(uvec4(texel.x) << uvec4(24, 16, 8, 0)) >> 24);
}

void main() {
  at = ivec2(gl_FragCoord.xy);
  if (at.y * textureSize(places, 0).x + at.x >= points) discard;
  if (meanOnly) {
    colour = texelFetch(means, at, 0);
    if (rooted) colour = sqrt(colour);
    return;
  }
  uint mirror = mirrored ? texelFetch(directions, at, 0).x : 0xffffffffu;
  vec2 place = tablePlace(direction(placeOf(texelFetch(places, at, 0)), mirror));
  vec3 sum = vec3(0), rest = vec3(0);
  for (int l = 0; l < layers; ++l) {
    vec4 e = textureLod(functions, vec3(place, float(l)), 0.0);
    sum.x += dot(next(), e);
    sum.y += dot(next(), e);
    sum.z += dot(next(), e);
  }
  for (int f = 0; f < fine; ++f) rest += next().xyz * textureLod(functions, vec3(place, float(f >> 2)), 0.0)[f & 3];
  vec3 c = clamp(sum / 127.0 + rest / 32512.0, 0.0, brightest);
  colour = vec4(rooted ? sqrt(c) : c, 1);
}`;

/**
 * A disc is a sprite, one vertex and no triangle, where it is small and its centre in the picture: what draws sprites and
 * what draws quads share the discs out among them. A sprite is as wide as it is high.
 */
const DISC_VERTEX = (blending, sprites) => `${HEAD}${UNPACK}
uniform usampler2D places;
uniform sampler2D colours;
uniform bool rooted;     // colours are square roots
uniform mat3 rotation;   // world to camera: right, down, forward
uniform vec3 eye;
uniform vec2 focal, centre, size;  // pixels; rows upwards
uniform int first;       // of this draw
uniform float thinning;  // every how many-th point is drawn
uniform float largestSprite;  // pixels; 0: there are none
uniform float nearest;   // the greatest inverse depth that there can be
flat out vec2 at;        // of the disc's centre, pixels
flat out vec4 ellipse;   // a, b, c of a x^2 + 2 b x y + c y^2 < 1, weight at the centre
flat out vec4 plane;     // inverse depth, its gradient in the image, 1 / the inverse depth of the band
flat out vec2 cover;     // squared radius that is wholly covered; share at the centre
${blending ? `flat out vec3 colour;${HIDDEN}` : ''}
const float FLATTEST = 0.1, STEEPEST = 0.3, BAND = 0.8, FILTER = 1.0, SHARE = 0.85;
const float LARGEST = 512.0, STEEPEST_PLANE = 0.75, MOST_SHIFT = 0.6;

void main() {
  gl_Position = vec4(2, 2, 0, 1);  // outside, until it is known to show
  int point = int(float(first + (gl_VertexID${sprites ? '' : ' >> 2'})) * thinning);
  int columns = textureSize(places, 0).x;
  ivec2 texel = ivec2(point % columns, point / columns);
  uvec4 disc = texelFetch(places, texel, 0);
  vec2 radiusShare = unpackHalf2x16(disc.w);
  float radius = radiusShare.x * sqrt(thinning);
  vec3 place = placeOf(disc), normal = vec3(0);
  if (disc.y >> 31 == 1u) {
    normal = octahedral(disc.z, 12);
    place += float(int(disc.z) >> 24) * (MOST_SHIFT / 127.0) * normal;
  }
  vec3 p = rotation * (place - eye);
  if (!(p.z > radius)) return;
  float near = 1.0 / p.z;
  at = centre + focal * p.xy * near;
  vec2 most = radius * abs(focal) * near;  // no disc reaches farther, a pixel more and its slant apart
  float width = 2.0 * max(most.x, most.y) * (1.0 + dot(p.xy, p.xy) * near * near) + 4.0;
  bool sprite = width <= largestSprite && all(greaterThanEqual(at, vec2(0))) && all(lessThan(at, size));
  if (sprite != ${sprites}) return;

  // E.3: the normal is turned to the eye, no flatter than a voxel is thick.
  vec3 toEye = -normalize(p), n = toEye;
  float cosine = 1.0;
  if (dot(normal, normal) > 0.5) {
    n = rotation * normal;
    cosine = dot(n, toEye);
    if (cosine < 0.0) {
      n = -n;
      cosine = -cosine;
    }
    if (cosine < FLATTEST) {
      n = sqrt((1.0 - FLATTEST * FLATTEST) / max(1.0 - cosine * cosine, 1e-12)) *
          (n - cosine * toEye) + FLATTEST * toEye;
      cosine = FLATTEST;
    }
  }
  float square = radius * radius;
  vec3 ju = focal.x * near * vec3(1, 0, -p.x * near), jv = focal.y * near * vec3(0, 1, -p.y * near);
  float nu = dot(ju, n), nv = dot(jv, n), area = square * dot(n, cross(ju, jv));
  float uu = square * (dot(ju, ju) - nu * nu) + FILTER, vv = square * (dot(jv, jv) - nv * nv) + FILTER;
  float uv = square * (dot(ju, jv) - nu * nv);
  vec2 reach = sqrt(vec2(uu, vv));
  if (max(reach.x, reach.y) >= LARGEST || any(lessThan(at + reach, vec2(0))) ||
      any(greaterThan(at - reach, size))) return;

  // E.4: the plane's inverse depth is linear in the image.
  vec2 slope = n.xy / (dot(n, p) * focal);
  float change = sqrt(max(0.0, slope.x * slope.x * uu + 2.0 * slope.x * slope.y * uv + slope.y * slope.y * vv));
  slope *= min(1.0, STEEPEST_PLANE * near / max(change, 1e-30));
  float pixel = p.z / focal.x;
  float band = BAND * sqrt(square + FILTER * pixel * pixel) / max(cosine, STEEPEST);
  float inverse = 1.0 / (uu * vv - uv * uv);
  plane = vec4(near, slope, p.z * p.z / band);
  // What of the disc and its band is nearest: all of it is hidden (m = 0) behind an occluder that is nearer.
  float front = min(1.0, (near + min(change, STEEPEST_PLANE * near) + 1.0 / plane.w) / nearest + 1e-6);
  ${blending ? 'if (hidden(at - reach, at + reach, front)) return;' : ''}
  ellipse = vec4(vv, -uv, uu, 0) * inverse;
  ellipse.w = radiusShare.y * max(abs(area) * sqrt(inverse), 3.2e-5);
  // E.5: within this radius the disc covers pixels in every direction.
  float mean = 0.5 * (ellipse.x + ellipse.z), half_ = 0.5 * (ellipse.x - ellipse.z);
  float minor = 1.0 / (mean + sqrt(half_ * half_ + ellipse.y * ellipse.y));
  float inner = max(0.0, (SHARE * sqrt(max(0.0, minor - FILTER)) - 0.5) * inversesqrt(minor));
  cover = vec2(inner * inner,
               0.5 + SHARE * sqrt(max(0.0, 1.0 / max(ellipse.x, ellipse.z) - FILTER)));
${
  blending
    ? `  colour = texelFetch(colours, texel, 0).rgb;
  if (rooted) colour *= colour;
`
    : ''
}
  reach *= ${blending ? '1.0' : '0.6324556'};  // the depth of a pixel is fixed by cores: r^2 < 0.4
  ${
    sprites
      ? `gl_PointSize = 2.0 * max(reach.x, reach.y) + 1.0;
  vec2 corner = vec2(0);`
      : 'vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1 & 1) * 2.0 - 1.0;'
  }
  gl_Position = vec4((at + reach * corner) / size * 2.0 - 1.0, 2.0 * front - 1.0, 1);
}`;

/** @param {'quads'|'sprites'} kind */
export const depthVertex = (kind) => DISC_VERTEX(false, kind === 'sprites');
export const blendVertex = (kind) => DISC_VERTEX(true, kind === 'sprites');

/** Greatest inverse depth of cores, by the depth test; its last bit: the disc covers the pixel wholly (E.5). */
export const DEPTH_FRAGMENT = `${HEAD}
uniform float nearest;
flat in vec2 at, cover;
flat in vec4 ellipse, plane;
void main() {
  vec2 d = gl_FragCoord.xy - at;
  float r2 = d.x * (ellipse.x * d.x + 2.0 * ellipse.y * d.y) + ellipse.z * d.y * d.y;
  if (r2 >= 0.4) discard;
  uint depth = floatBitsToUint(clamp((plane.x + dot(plane.yz, d)) / nearest, 0.0, 1.0));
  gl_FragDepth = uintBitsToFloat(r2 <= cover.x && dot(d, d) >= 1e-4 ? depth | 1u : depth & ~1u);
}`;

/** Weighted colours (sums), the share that a disc covers (greatest), weights (sums). */
export const BLEND_FRAGMENT = `${HEAD}
uniform sampler2D depth;
uniform float nearest;
flat in vec2 at;
flat in vec4 ellipse, plane;
flat in vec3 colour;
flat in vec2 cover;
layout(location = 0) out vec4 weighted;
layout(location = 1) out vec4 weight;

float share(vec2 d, float r2) {
  float square = dot(d, d);
  if (square < 1e-4) return cover.y;
  if (r2 <= cover.x) return 1.0;
  vec2 gradient = vec2(ellipse.x * d.x + ellipse.y * d.y, ellipse.y * d.x + ellipse.z * d.y);
  float edge = 0.85 * sqrt(max(0.0, square / r2 - 1.0));
  return 0.5 + (edge - sqrt(square)) * r2 * inversesqrt(square * dot(gradient, gradient));
}

void main() {
  vec2 d = gl_FragCoord.xy - at;
  float r2 = d.x * (ellipse.x * d.x + 2.0 * ellipse.y * d.y) + ellipse.z * d.y * d.y;
  if (r2 >= 1.0) discard;
  float front = texelFetch(depth, ivec2(gl_FragCoord.xy), 0).x * nearest;
  float m = clamp(1.0 - (front - plane.x - dot(plane.yz, d)) * plane.w, 0.0, 1.0);
  float kernel = (1.0 - r2) * (1.0 - r2) * m;
  float w = ellipse.w * kernel * kernel;
  weighted = vec4(w * colour, clamp(share(d, r2), 0.0, 1.0));
  weight = vec4(w);
}`;

/** The mean over what is behind it; coverage is the greater of density and discs. */
export const RESOLVE_FRAGMENT = `${HEAD}
uniform sampler2D weighted, weight, depth;
uniform vec4 viewport;           // of the target; the sums may be coarser
uniform float nearest, exposure;  // factor in linear light
uniform bool linear, toLinear;    // transfer of the light field; of the target
uniform vec2 depthRange;          // target depth = x + y * inverse depth
out vec4 colour;

${TRANSFERS}
void main() {
  vec2 at = (gl_FragCoord.xy - viewport.xy) / viewport.zw;
  float sum = texture(weight, at).x;
  if (!(sum > 0.0)) discard;
  vec4 own = texture(weighted, at);
  float cover = clamp(max(2.0 * 5.0 / 3.14159265358979 * sum - 0.5, own.a), 0.0, 1.0);
  vec3 c = clamp(own.rgb / sum, 0.0, 1.0);
  if (exposure != 1.0 || toLinear) {
    c = min(exposure * (linear ? c : fromDisplay(c)), 1.0);
    if (!toLinear) c = toDisplay(c);
  } else if (linear) {
    c = toDisplay(c);
  }
  colour = vec4(cover * c, cover);
  gl_FragDepth = clamp(depthRange.x + depthRange.y * texture(depth, at).x * nearest, 0.0, 1.0);
}`;
