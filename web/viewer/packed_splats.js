// SPDX-License-Identifier: Apache-2.0
// Splats as the texels that their pipeline uploads; as packed_field.js, without DOM and WebGL.
import { writeSplat } from './packed_texels.js';

const LEAST_ALPHA = 1 / 255; // below which a splat does not show: spec E.6
const NEAREST = 0.2, // depth before which nothing is drawn, world units,
  NEAREST_SHARE = 0.02; // or a share of the radius of a smaller scene, as lightfield/render/gaussian_cloud.cpp has it

const STANDS_FOR = 0.3; // variance of a splat that stands for many, of the area of the surface that it stands for

/** Squared deviations at which a splat ends; 0 or less: it never shows. */
export const reachOf = (opacity) => 2 * Math.log(opacity / LEAST_ALPHA);

/**
 * @param {boolean} arriving  means of splats that are still on their way are widened, so that nothing shines through
 * @param ball  of boundingBall()
 * @param {number} texels  columns times rows
 * @returns places, tails: of packed_texels.js; means; nearest: depth before which nothing is drawn; box: of all splats, each
 *   as far as it shows along an axis. Lengths in voxels, of the box from the middle
 */
export function packSplats(field, ball, texels, arriving) {
  const { points, positions, covariances, opacities, grid } = field,
    means = field.meanColours(),
    areas = arriving && points < field.info.points ? field.areas : null,
    unit = 1 / grid.step ** 2,
    low = [0, 0, 0].fill(points ? Infinity : 0),
    high = [0, 0, 0].fill(points ? -Infinity : 0);
  const out = {
    splats: true,
    nearest: ball.radius > 0 ? Math.min(NEAREST / grid.step, NEAREST_SHARE * ball.radius) : NEAREST / grid.step,
    places: new Uint32Array(4 * texels),
    tails: new Uint32Array(2 * texels),
    means: new Uint8Array(4 * texels),
  };
  for (let p = 0; p < points; ++p) {
    const place = positions.subarray(3 * p, 3 * p + 3),
      covariance = Array.from(covariances.subarray(6 * p, 6 * p + 6), (v) => v * unit),
      wider = areas ? STANDS_FOR * unit * areas[p] : 0,
      shows = covariance.every(Number.isFinite) && opacities[p] > LEAST_ALPHA;
    for (const k of [0, 3, 5]) covariance[k] += wider;
    writeSplat(out.places, out.tails, p, place, shows ? covariance : [0, 0, 0, 0, 0, 0], shows ? opacities[p] : 0);
    out.means.set([...means.subarray(3 * p, 3 * p + 3), 255], 4 * p);
    for (let k = 0; k < 3; ++k) {
      const at = place[k] - ball.centre[k],
        reach = shows ? Math.sqrt(reachOf(opacities[p]) * covariance[[0, 3, 5][k]]) : 0;
      low[k] = Math.min(low[k], at - reach);
      high[k] = Math.max(high[k], at + reach);
    }
  }
  return { ...out, box: [low, high] };
}
