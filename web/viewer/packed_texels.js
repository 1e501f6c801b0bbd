// SPDX-License-Identifier: Apache-2.0
// Points in a texel of 16 bytes, as packed_field.js writes it and shaders.js (UNPACK) reads it: the place in 21 bits an
// axis, which is every place of a file, and what shapes the point.
//
//   word 0   x, and 11 bits of y
//   word 1   10 bits of y, z; bit 31: the disc has a normal
//   discs    word 2: normal, 12 and 12 bits; shift along it, 8 bits. Word 3: radius, share of its square that it stands for
//   splats   words 2, 3 and two of another texture: the triangle L of a covariance L L', row by row, and opacity

const PLACE = 0x1fffff,
  NORMAL_BITS = 12,
  MIRROR_BITS = 16,
  MOST_SHIFT = 0.6; // voxels: kMostShift of lightfield/render/surfel_cloud.cpp

export const NO_DIRECTION = 0xffffffff; // in place of a normal that mirrors

const real = new Float32Array(1),
  bits = new Uint32Array(real.buffer);

/** Nearest half float, of a number 0 or more; 65504 is the most. */
export function toHalf(number) {
  real[0] = Math.min(65504, number) * 2 ** -112; // exponents of both are alike there, and so are their denormals
  return (bits[0] + 0xfff + ((bits[0] >> 13) & 1)) >> 13;
}

export function fromHalf(half) {
  bits[0] = (half & 0x7fff) << 13;
  return (half & 0x8000 ? -1 : 1) * real[0] * 2 ** 112;
}

export const toSignedHalf = (number) => (number < 0 ? 0x8000 | toHalf(-number) : toHalf(number));

/** A direction on an octahedron laid flat, `size` bits an axis; 0 is a level of both. */
function toOctahedral(x, y, z, size) {
  const most = 2 ** (size - 1) - 1,
    sum = Math.abs(x) + Math.abs(y) + Math.abs(z) || 1;
  let u = x / sum,
    v = y / sum;
  if (z < 0) [u, v] = [(1 - Math.abs(v)) * (u < 0 ? -1 : 1), (1 - Math.abs(u)) * (v < 0 ? -1 : 1)];
  return (Math.round((u + 1) * most) | (Math.round((v + 1) * most) << size)) >>> 0;
}

function fromOctahedral(code, size) {
  const most = 2 ** (size - 1) - 1,
    mask = 2 ** size - 1;
  let u = (code & mask) / most - 1,
    v = ((code >>> size) & mask) / most - 1;
  const z = 1 - Math.abs(u) - Math.abs(v);
  if (z < 0) [u, v] = [(1 - Math.abs(v)) * (u < 0 ? -1 : 1), (1 - Math.abs(u)) * (v < 0 ? -1 : 1)];
  const length = Math.hypot(u, v, z);
  return [u / length, v / length, z / length];
}

export const toMirror = (x, y, z) => (x * x + y * y + z * z > 0.5 ? toOctahedral(x, y, z, MIRROR_BITS) : NO_DIRECTION);
export const fromMirror = (code) => (code === NO_DIRECTION ? null : fromOctahedral(code, MIRROR_BITS));

function writePlace(places, at, [x, y, z], flag) {
  places[at] = x | (y << 21);
  places[at + 1] = (y >>> 11) | (z << 10) | (flag << 31);
}

/** A place in voxels of the grid. @param {number} p  of the point */
export const placeOf = ({ places }, p) => [
  places[4 * p] & PLACE,
  (places[4 * p] >>> 21) | ((places[4 * p + 1] & 0x3ff) << 11),
  (places[4 * p + 1] >>> 10) & PLACE,
];

/**
 * @param place  whole voxels of the grid  @param normal  of length 1, or 0: it faces the eye
 * @param {number} shift  of its centre along the normal  @param {number} radius  voxels
 * @param {number} share  of the radius's square
 */
export function writeDisc(places, p, place, normal, shift, radius, share) {
  const [x, y, z] = normal,
    has = x * x + y * y + z * z > 0.5 ? 1 : 0,
    step = Math.round((Math.max(-MOST_SHIFT, Math.min(MOST_SHIFT, shift)) / MOST_SHIFT) * 127);
  writePlace(places, 4 * p, place, has);
  places[4 * p + 2] = has ? toOctahedral(x, y, z, NORMAL_BITS) | (step << 24) : 0;
  places[4 * p + 3] = toHalf(radius) | (toHalf(share) << 16);
}

export const radiusOf = ({ places }, p) => fromHalf(places[4 * p + 3] & 0xffff);
/** Null of a disc that faces the eye. */
export const normalOf = ({ places }, p) => (places[4 * p + 1] >>> 31 ? fromOctahedral(places[4 * p + 2], NORMAL_BITS) : null);
export const shiftOf = ({ places }, p) => ((places[4 * p + 2] | 0) >> 24) * (MOST_SHIFT / 127);

/**
 * @param {number[]} covariance  xx, xy, xz, yy, yz, zz; voxels squared
 * @param {number} opacity  0: it never shows
 */
export function writeSplat(places, tails, p, place, [xx, xy, xz, yy, yz, zz], opacity) {
  writePlace(places, 4 * p, place, 0);
  const root = (v) => Math.sqrt(Math.max(0, v)),
    over = (v, by) => (by > 0 ? v / by : 0);
  const a = root(xx),
    b = over(xy, a),
    c = over(xz, a),
    d = root(yy - b * b),
    e = over(yz - b * c, d),
    f = root(zz - c * c - e * e);
  places[4 * p + 2] = toHalf(a) | (toSignedHalf(b) << 16);
  places[4 * p + 3] = toHalf(d) | (toSignedHalf(c) << 16);
  tails[2 * p] = toHalf(f) | (toSignedHalf(e) << 16);
  tails[2 * p + 1] = toHalf(opacity);
}

/** @returns {{covariance: number[], opacity: number}} as it is drawn */
export function splatOf({ places, tails }, p) {
  const low = (word) => fromHalf(word & 0xffff),
    high = (word) => fromHalf(word >>> 16);
  const [a, b] = [low(places[4 * p + 2]), high(places[4 * p + 2])],
    [d, c] = [low(places[4 * p + 3]), high(places[4 * p + 3])],
    [f, e] = [low(tails[2 * p]), high(tails[2 * p])];
  const covariance = [a * a, a * b, a * c, b * b + d * d, b * c + d * e, c * c + e * e + f * f];
  return { covariance, opacity: low(tails[2 * p + 1]) };
}
