// SPDX-License-Identifier: Apache-2.0
// Splats as the texels that their pipeline uploads; as packed_field.js, without DOM and WebGL.

const LEAST_ALPHA = 1 / 255; // below which a splat does not show: spec E.6
const NEAREST = 0.2, // depth before which nothing is drawn, world units,
  NEAREST_SHARE = 0.02; // or a share of the radius of a smaller scene, as lightfield/render/gaussian_cloud.cpp has it

const STANDS_FOR = 0.3; // variance of a splat that stands for many, of the area of the surface that it stands for

/**
 * Lengths in voxels from the middle of the box.
 * @param {boolean} arriving  means of splats that are still on their way are widened, so that nothing shines through
 * @param ball  of boundingBall()
 * @param {number} texels  columns times rows
 * @returns places: x, y, z, squared deviations at which a splat ends (0: it never shows); spreads: covariance xx, yy, zz,
 *   opacity; tilts: covariance xy, xz, yz; means; nearest: depth before which nothing is drawn
 */
export function packSplats(field, ball, texels, arriving) {
  const { points, positions, covariances, opacities, grid } = field,
    means = field.meanColours(),
    areas = arriving && points < field.info.points ? field.areas : null,
    unit = 1 / grid.step ** 2;
  const out = {
    splats: true,
    nearest: ball.radius > 0 ? Math.min(NEAREST / grid.step, NEAREST_SHARE * ball.radius) : NEAREST / grid.step,
    places: new Float32Array(4 * texels),
    spreads: new Float32Array(4 * texels),
    tilts: new Float32Array(4 * texels),
    means: new Uint8Array(4 * texels),
  };
  for (let p = 0; p < points; ++p) {
    const [xx, xy, xz, yy, yz, zz] = covariances.subarray(6 * p, 6 * p + 6).map((v) => v * unit),
      wider = areas ? STANDS_FOR * unit * areas[p] : 0,
      reach = 2 * Math.log(opacities[p] / LEAST_ALPHA),
      sound = [xx, xy, xz, yy, yz, zz].every(Number.isFinite);
    out.places.set([0, 1, 2].map((k) => positions[3 * p + k] - ball.centre[k]), 4 * p);
    out.means.set([...means.subarray(3 * p, 3 * p + 3), 255], 4 * p);
    if (!sound || !(reach > 0)) continue;
    out.places[4 * p + 3] = reach;
    out.spreads.set([xx + wider, yy + wider, zz + wider, opacities[p]], 4 * p);
    out.tilts.set([xy, xz, yz], 4 * p);
  }
  return out;
}

/** The box of all splats, each as far as it shows along an axis; voxels from the middle. */
export function boxOfSplats({ places, spreads }, points) {
  const low = [0, 0, 0].fill(points ? Infinity : 0),
    high = [0, 0, 0].fill(points ? -Infinity : 0);
  for (let p = 0; p < 4 * points; p += 4)
    for (let k = 0; k < 3; ++k) {
      const reach = Math.sqrt(places[p + 3] * spreads[p + k]);
      low[k] = Math.min(low[k], places[p + k] - reach);
      high[k] = Math.max(high[k], places[p + k] + reach);
    }
  return [low, high];
}
