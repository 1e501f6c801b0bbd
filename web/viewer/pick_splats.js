// SPDX-License-Identifier: Apache-2.0
// Where a ray meets splats: where half of what is behind is hidden, on the processor. Lengths as in pick.js.

import { reachOf } from './packed_splats.js';
import { placeOf, splatOf } from './packed_texels.js';

const HALF = 0.5, // of what is behind, as the depth of the C++ renderer
  THINNEST = 0.01; // variance that a splat has at least, voxels squared: a disc's inverse stays a number

/** As pick() of pick.js; the normal is that of the splat's plane through its greatest share along the ray. */
export function pickSplat(packed, from, along, share = 1) {
  const drawn = Math.max(1, Math.round(packed.points * Math.min(1, share))),
    thinning = packed.points / drawn,
    eye = from.map((v, k) => v + packed.middle[k]),
    met = [];
  for (let i = 0; i < drawn && packed.points > 0; ++i) {
    const index = Math.floor(i * thinning),
      x = placeOf(packed, index).map((v, k) => v - eye[k]),
      near = dot(x, along);
    if (near < 0) continue;
    const { covariance, opacity } = splatOf(packed, index),
      reach = reachOf(opacity);
    const square = dot(x, x) - near * near, // no farther than its longest axis shows
      widest = thinning * reach * (covariance[0] + covariance[3] + covariance[5] + 3 * THINNEST);
    if (!(square <= widest)) continue;
    const found = meetSplat(covariance, opacity, thinning, x, along);
    if (found.distance > 0 && found.square < reach) met.push({ index, ...found });
  }
  let clear = 1;
  for (const { index, distance, normal, hides } of met.sort((a, b) => a.distance - b.distance)) {
    clear *= 1 - hides;
    if (clear <= HALF) return { index, distance, normal };
  }
  return null;
}

/** Where a splat about x is densest along a ray from the origin. */
function meetSplat(covariance, opacity, thinning, x, along) {
  const [a, d, f] = [0, 3, 5].map((k) => thinning * covariance[k] + THINNEST),
    [b, c, e] = [1, 2, 4].map((k) => thinning * covariance[k]);
  const rows = [
    [d * f - e * e, c * e - b * f, b * e - c * d],
    [c * e - b * f, a * f - c * c, b * c - a * e],
    [b * e - c * d, b * c - a * e, a * d - b * b],
  ];
  const determinant = a * rows[0][0] + b * rows[0][1] + c * rows[0][2],
    times = (v) => rows.map((row) => dot(row, v) / determinant);
  const across = times(along),
    distance = dot(across, x) / dot(across, along),
    rest = x.map((v, k) => v - distance * along[k]),
    length = -Math.hypot(...across);
  const square = Math.max(0, dot(rest, times(rest)));
  return { distance, square, normal: across.map((v) => v / length), hides: Math.min(0.99, opacity * Math.exp(-square / 2)) };
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
