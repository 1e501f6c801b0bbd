// SPDX-License-Identifier: Apache-2.0
// GLSL of the reference reconstruction, spec annex E. Lengths are voxels, colours 0 .. 1, images have
// their first row at the bottom, as WebGL has it. The constants are those of lightfield/render/reference_kernel.h.

export const HEAD = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler2DArray;
precision highp isampler2DArray;
`;

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
export const COLOUR_FRAGMENT = `${HEAD}
uniform sampler2D places;         // x, y, z, shift along the normal
uniform sampler2D directions;     // normal that mirrors the direction (0: none, directions of the world), area share
uniform sampler2D means;          // mean colour
uniform isampler2DArray weights;  // layer 3 l + c: weights in channel c of functions 4 l .. 4 l + 3
uniform sampler2DArray functions; // layer l: functions 4 l .. 4 l + 3, scaled to the weights
uniform vec3 eye;
uniform vec2 gamma;
uniform int points, layers;
uniform float faceSize;  // texels along a face of the table
uniform bool meanOnly;
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
vec3 direction(vec3 place, vec3 n) {
  vec3 to = eye - place;
  vec3 w = dot(to, to) > 0.0 ? normalize(to) : vec3(1, 0, 0);
  if (dot(n, n) > 0.5) w = 2.0 * dot(n, w) * n - w;
  float g = clamp(w.z, gamma.x, gamma.y);
  if (g == w.z) return w;
  float across = length(w.xy), rest = sqrt(max(0.0, 1.0 - g * g));
  return across > 0.0 ? vec3(w.xy * (rest / across), g) : vec3(rest, 0, g);
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  if (at.y * textureSize(places, 0).x + at.x >= points) discard;
  if (meanOnly) {
    colour = texelFetch(means, at, 0);
    return;
  }
  vec2 place = tablePlace(direction(texelFetch(places, at, 0).xyz, texelFetch(directions, at, 0).xyz));
  vec3 sum = vec3(0);
  for (int l = 0; l < layers; ++l) {
    vec4 e = textureLod(functions, vec3(place, float(l)), 0.0);
    sum += vec3(dot(vec4(texelFetch(weights, ivec3(at, 3 * l), 0)), e),
                dot(vec4(texelFetch(weights, ivec3(at, 3 * l + 1), 0)), e),
                dot(vec4(texelFetch(weights, ivec3(at, 3 * l + 2), 0)), e));
  }
  colour = vec4(clamp(sum / 32767.0, 0.0, brightest), 1);
}`;

const DISC_VERTEX = (blending) => `${HEAD}
uniform sampler2D places, discs, directions, colours;
uniform mat3 rotation;   // world to camera: right, down, forward
uniform vec3 eye;
uniform vec2 focal, centre, size;  // pixels; rows upwards
uniform int first;       // of this draw
uniform float thinning;  // every how many-th point is drawn
flat out vec2 at;        // of the disc's centre, pixels
flat out vec4 ellipse;   // a, b, c of a x^2 + 2 b x y + c y^2 < 1, weight at the centre
flat out vec4 plane;     // inverse depth, its gradient in the image, 1 / the inverse depth of the band
${
  blending
    ? `flat out vec3 colour;
flat out vec2 cover;     // squared radius that is wholly covered; share at the centre`
    : ''
}

const float FLATTEST = 0.1, STEEPEST = 0.3, BAND = 0.8, FILTER = 1.0, SHARE = 0.85;
const float LARGEST = 512.0, STEEPEST_PLANE = 0.75;

void main() {
  gl_Position = vec4(2, 2, 0, 1);  // outside, until it is known to show
  int point = int(float(first + (gl_VertexID >> 2)) * thinning);
  int columns = textureSize(places, 0).x;
  ivec2 texel = ivec2(point % columns, point / columns);
  vec4 disc = texelFetch(discs, texel, 0), place = texelFetch(places, texel, 0);
  float radius = disc.w * sqrt(thinning);
  vec3 p = rotation * (place.xyz + place.w * disc.xyz - eye);
  if (!(p.z > radius)) return;

  // E.3: the normal is turned to the eye, no flatter than a voxel is thick.
  vec3 toEye = -normalize(p), n = toEye;
  float cosine = 1.0;
  if (dot(disc.xyz, disc.xyz) > 0.5) {
    n = rotation * disc.xyz;
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
  float near = 1.0 / p.z, square = radius * radius;
  vec3 ju = focal.x * near * vec3(1, 0, -p.x * near), jv = focal.y * near * vec3(0, 1, -p.y * near);
  float nu = dot(ju, n), nv = dot(jv, n), area = square * dot(n, cross(ju, jv));
  float uu = square * (dot(ju, ju) - nu * nu) + FILTER, vv = square * (dot(jv, jv) - nv * nv) + FILTER;
  float uv = square * (dot(ju, jv) - nu * nv);
  vec2 reach = sqrt(vec2(uu, vv));
  at = centre + focal * p.xy * near;
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
  ellipse = vec4(vv, -uv, uu, 0) * inverse;
  ellipse.w = texelFetch(directions, texel, 0).w * max(abs(area) * sqrt(inverse), 3.2e-5);
${
  blending
    ? `
  colour = texelFetch(colours, texel, 0).rgb;
  // E.5: within this radius the disc covers pixels in every direction.
  float mean = 0.5 * (ellipse.x + ellipse.z), half_ = 0.5 * (ellipse.x - ellipse.z);
  float minor = 1.0 / (mean + sqrt(half_ * half_ + ellipse.y * ellipse.y));
  float inner = max(0.0, (SHARE * sqrt(max(0.0, minor - FILTER)) - 0.5) * inversesqrt(minor));
  cover = vec2(inner * inner,
               0.5 + SHARE * sqrt(max(0.0, 1.0 / max(ellipse.x, ellipse.z) - FILTER)));
`
    : ''
}
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1 & 1) * 2.0 - 1.0;
  float span = ${blending ? '1.0' : '0.6324556'};  // the depth of a pixel is fixed by cores: r^2 < 0.4
  gl_Position = vec4((at + span * reach * corner) / size * 2.0 - 1.0, 0, 1);
}`;

export const DEPTH_VERTEX = DISC_VERTEX(false);
export const BLEND_VERTEX = DISC_VERTEX(true);

/** Greatest inverse depth of cores, by the depth test. */
export const DEPTH_FRAGMENT = `${HEAD}
uniform float nearest;  // the greatest inverse depth that there can be
flat in vec2 at;
flat in vec4 ellipse, plane;
void main() {
  vec2 d = gl_FragCoord.xy - at;
  if (d.x * (ellipse.x * d.x + 2.0 * ellipse.y * d.y) + ellipse.z * d.y * d.y >= 0.4) discard;
  gl_FragDepth = (plane.x + dot(plane.yz, d)) / nearest;
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
