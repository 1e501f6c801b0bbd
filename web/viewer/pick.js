// SPDX-License-Identifier: Apache-2.0
// Where a ray meets a light field, and the colour that is seen that way: on the processor, from the texels that the
// pipeline uploads. Lengths in voxels from `packed.centre`, as these texels are.

import { MOST_SHARE } from './packed_functions.js';
import { fromHalf, fromMirror, normalOf, placeOf, radiusOf, shiftOf } from './packed_texels.js';
import { pickSplat } from './pick_splats.js';

const CORE = 0.4; // squared share of a disc's radius within which it fixes the depth: spec E.4

/**
 * @param {number[]} from  @param {number[]} along  of length 1
 * @param {number} share  of the points that are drawn
 * @returns {{index, distance, normal}|null} the first disc whose core is met, else the first disc; its normal looks back
 */
export function pick(packed, from, along, share = 1) {
  if (packed.splats) return pickSplat(packed, from, along, share);
  const drawn = Math.max(1, Math.round(packed.points * Math.min(1, share))),
    thinning = packed.points / drawn,
    eye = from.map((v, k) => v + packed.middle[k]);
  let core = null,
    rim = null;
  for (let i = 0; i < drawn && packed.points > 0; ++i) {
    const index = Math.floor(i * thinning),
      square = radiusOf(packed, index) ** 2 * thinning,
      centre = placeOf(packed, index).map((v, k) => v - eye[k]),
      near = dot(centre, along),
      shift = Math.abs(shiftOf(packed, index));
    if (near < -shift || dot(centre, centre) - near * near > (Math.sqrt(square) + shift) ** 2) continue; // not even its ball
    const met = meetDisc(packed, index, centre, along);
    if (!met || met.square >= square) continue;
    if (met.square < CORE * square && !(core?.distance <= met.distance)) core = { index, ...met };
    else if (!(rim?.distance <= met.distance)) rim = { index, ...met };
  }
  const found = core ?? rim;
  return found && { index: found.index, distance: found.distance, normal: found.normal };
}

/** The place in the world under a point of a stage, in pixels of the page; null beside the object. */
export function placeAt(stage, x, y) {
  const { packed, canvas } = stage,
    view = stage.view(canvas.clientWidth, canvas.clientHeight);
  const across = (x - view.cx) / view.fx,
    down = (y - view.cy) / view.fy;
  const along = normalised([0, 1, 2].map((k) => across * view.rotation[k] + down * view.rotation[3 + k] + view.rotation[6 + k]));
  const met = pick(packed, view.eye.map((v, k) => (v - packed.centre[k]) / packed.step), along, stage.look.share);
  return met && view.eye.map((v, k) => v + met.distance * packed.step * along[k]);
}

/** Where a ray from the origin meets the plane of a disc: how far, and how far from its centre, squared. */
function meetDisc(packed, index, place, along) {
  const own = normalOf(packed, index),
    shift = shiftOf(packed, index),
    centre = own ? place.map((v, k) => v + shift * own[k]) : place,
    near = dot(centre, along);
  if (near < 0) return null;
  let normal = own ?? along.map((x) => -x);
  const slope = dot(normal, along);
  if (slope > 0) normal = normal.map((x) => -x);
  const distance = Math.abs(slope) < 1e-6 ? near : dot(normal, centre) / -Math.abs(slope);
  if (!(distance > 0)) return null;
  return { distance, normal, square: centre.reduce((sum, x, k) => sum + (distance * along[k] - x) ** 2, 0) };
}

/** RGB 0 .. 1 of a point from `eye`, in the file's own transfer: the colour pass of shaders.js. Spec 6.4, 6.7. */
export function colourFrom(packed, index, eye, meanOnly = false) {
  const { means, functions, layers, fine } = packed;
  if (meanOnly) return [0, 1, 2].map((k) => means[4 * index + k] / 255);
  const at = tableAt(functions, direction(packed, index, eye)),
    sum = [0, 0, 0];
  for (let f = 0; f < 4 * layers; ++f) {
    const value = at(f >> 2, f & 3);
    for (let c = 0; c < 3; ++c) {
      sum[c] += value * 256 * weightByte(packed, index, 3 * (f >> 2) + c, f & 3);
      if (f < fine) sum[c] += value * weightByte(packed, index, 3 * layers + f, c);
    }
  }
  return sum.map((x) => Math.max(0, Math.min(1, x / MOST_SHARE)));
}

const weightByte = ({ weights, columns, rows }, index, word, byte) =>
  (weights[((word >> 2) * columns * rows + index) * 4 + (word & 3)] << (24 - 8 * byte)) >> 24;

/** The direction to the eye in the point's frame, within what cameras saw. */
function direction(packed, index, eye) {
  const { gamma, directions, middle } = packed,
    place = placeOf(packed, index);
  let w = normalised([0, 1, 2].map((k) => eye[k] + middle[k] - place[k])) ?? [1, 0, 0];
  const n = directions && fromMirror(directions[index]);
  if (n) {
    const twice = 2 * dot(n, w);
    w = w.map((x, k) => twice * n[k] - x);
  }
  const g = Math.max(gamma[0], Math.min(gamma[1], w[2]));
  if (g === w[2]) return w;
  const across = Math.hypot(w[0], w[1]),
    rest = Math.sqrt(Math.max(0, 1 - g * g));
  return across > 0 ? [(w[0] * rest) / across, (w[1] * rest) / across, g] : [rest, 0, g];
}

/** Values of the functions in a direction, between the four texels around it. @returns (layer, function) => value */
function tableAt({ texels, width, height, faceSize }, w) {
  const [ax, ay, az] = w.map(Math.abs);
  let face, s, t;
  if (ax >= ay && ax >= az) [face, s, t] = [w[0] < 0 ? 1 : 0, (w[0] < 0 ? w[2] : -w[2]) / ax, -w[1] / ax];
  else if (ay >= az) [face, s, t] = [w[1] < 0 ? 3 : 2, w[0] / ay, (w[1] < 0 ? -w[2] : w[2]) / ay];
  else [face, s, t] = [w[2] < 0 ? 5 : 4, (w[2] < 0 ? -w[0] : w[0]) / az, -w[1] / az];
  const place = [s, t].map((v) => (v * 0.5 + 0.5) * (faceSize - 1)),
    low = place.map((v) => Math.max(0, Math.min(faceSize - 2, Math.floor(v)))),
    [u, v] = place.map((x, k) => x - low[k]);
  const column = (face % 3) * faceSize + low[0],
    row = Math.floor(face / 3) * faceSize + low[1];
  return (layer, f) => {
    const value = (x, y) => fromHalf(texels[((layer * height + row + y) * width + column + x) * 4 + f]);
    return (1 - v) * ((1 - u) * value(0, 0) + u * value(1, 0)) + v * ((1 - u) * value(0, 1) + u * value(1, 1));
  };
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

function normalised(a) {
  const length = Math.hypot(...a);
  return length > 0 ? a.map((x) => x / length) : null;
}
