// SPDX-License-Identifier: Apache-2.0
// A decoded light field as the texels that the pipeline uploads: no DOM, no WebGL, so that a worker
// does it.

import { packFunctions } from './packed_functions.js';
import { packSplats } from './packed_splats.js';
import { toMirror, writeDisc } from './packed_texels.js';

export const COLUMNS = 1024;

/** What stands in the way of a file that is sound: too large for the device, without view maps. */
export class ViewerError extends Error {
  /**
   * @param {'too-large'|'no-view-maps'|'no-webgl2'|'damaged'|'unsupported'|'network'|'memory'|'policy'} kind
   * @param {string} words  for everybody
   * @param {string} detail  for those who look for the cause
   */
  constructor(kind, words, detail = '') {
    super(detail ? `${words} (${detail})` : words);
    this.name = 'ViewerError';
    Object.assign(this, { kind, words, detail });
  }

  /** Of what plainError() made. */
  static from({ kind, words, detail }) {
    return new ViewerError(kind, words, detail);
  }
}

/**
 * Texels of a light field, lengths in voxels.
 * @param field  of SlfDecoder.decode()
 * @param {number} tableSize  samples along a side of a face of the function table
 * @param {boolean} arriving  more of the file will come
 * @param {FrameFunctions|null} shared  what frames of one light field have in common
 * @returns {PackedField} typed arrays that can be transferred, and plain numbers; middle: of the box, which what draws has
 *   as the origin
 */
export function packField(field, tableSize = 65, arriving = false, shared = null) {
  const points = field.points,
    columns = Math.min(COLUMNS, Math.max(1, points));
  const rows = Math.max(1, Math.ceil(points / columns)),
    texels = columns * rows;
  const ball = boundingBall(field);
  const { box, ...own } = field.hasSplats ? packSplats(field, ball, texels, arriving) : packPlaces(field, ball.centre, texels);
  const toWorld = (place) => place.map((v, k) => field.grid.origin[k] + field.grid.step * (ball.centre[k] + v));
  return {
    points,
    columns,
    rows,
    components: field.components,
    ...packFunctions(field, texels, tableSize, shared),
    moving: shared !== null,
    gamma: Array.from(field.gamma),
    linear: field.transfer === 'linear',
    up: field.up,
    partial: Boolean(field.partial),
    levels: field.grid.bits,
    step: field.grid.step,
    middle: ball.centre,
    radius: (field.hasSplats && !ball.radius ? farthestOf(box) : ball.radius) * field.grid.step, // splats in one place
    reach: (field.hasSplats ? farthestOf(box) : ball.reach) * field.grid.step,
    size: ball.size.map((v) => v * field.grid.step),
    centre: ball.centre.map((c, k) => field.grid.origin[k] + field.grid.step * c),
    ...own,
    box: box.map(toWorld),
  };
}

/** Of all that can be transferred to another thread without a copy. */
export function buffersOf(packed) {
  return [...Object.values(packed), packed.functions.texels].filter(ArrayBuffer.isView).map((array) => array.buffer);
}

/** From the middle to the farthest corner of a box. */
const farthestOf = ([low, high]) => Math.hypot(...low.map((v, k) => Math.max(-v, high[k])));

const WIDE = 4, // of the box of all points, over that of most
  STRAY = 0.01, // share of points that may lie far away at either end of an axis,
  SKY = 0.1, // of splats
  FEWEST = 100; // points of which a few can be told

/** Without a share of the points at either end of each axis; of many points a sample tells. */
function boxOf(positions, tail) {
  const points = positions.length / 3,
    stride = tail ? Math.max(1, Math.floor(points / 65536)) : 1,
    low = [Infinity, Infinity, Infinity],
    high = [-Infinity, -Infinity, -Infinity];
  for (let k = 0; k < 3; ++k) {
    if (tail) {
      const values = new Int32Array(Math.ceil(points / stride)).map((_, i) => positions[3 * i * stride + k]).sort();
      low[k] = values[Math.floor(tail * (values.length - 1))];
      high[k] = values[Math.floor((1 - tail) * (values.length - 1))];
      continue;
    }
    for (let i = k; i < positions.length; i += 3) {
      if (positions[i] < low[k]) low[k] = positions[i];
      if (positions[i] > high[k]) high[k] = positions[i];
    }
  }
  return { low, high, side: Math.max(...high.map((v, k) => v - low[k])) };
}

/** The box of all points; where a few are far away, of those near the others. As slf render has it. */
function framedBox(positions, tail) {
  const all = boxOf(positions, 0);
  if (positions.length < 3 * FEWEST) return all;
  const most = boxOf(positions, tail);
  if (!(all.side > WIDE * most.side) || most.side === 0) return all;
  const margin = most.low.map((v, k) => (most.high[k] - v) / 2),
    kept = [];
  for (let i = 0; i < positions.length; i += 3) {
    const at = positions.subarray(i, i + 3);
    if (at.every((v, k) => v >= most.low[k] - margin[k] && v <= most.high[k] + margin[k])) kept.push(...at);
  }
  return kept.length ? boxOf(kept, 0) : all;
}

/** What a view of a frame without points frames: where points of the others can be. */
function wholeGrid(grid) {
  const side = 2 ** (grid?.bits ?? 0),
    reach = Math.max(1, (Math.sqrt(3) * side) / 2);
  return { centre: [0, 0, 0].fill((side - 1) / 2), radius: reach, reach, size: [side, side, side] };
}

/**
 * The middle of the box that views frame, the farthest of its points from there (`radius`) and of all points
 * (`reach`); voxels.
 */
export function boundingBall({ positions, grid, hasSplats }) {
  if (!positions.length) return wholeGrid(grid);
  const { low, high } = framedBox(positions, hasSplats ? SKY : STRAY),
    centre = low.map((v, k) => (v + high[k]) / 2);
  let square = 0,
    farthest = 0;
  for (let i = 0; i < positions.length; i += 3) {
    let distance = 0,
      inside = true;
    for (let k = 0; k < 3; ++k) {
      distance += (positions[i + k] - centre[k]) ** 2;
      inside &&= positions[i + k] >= low[k] && positions[i + k] <= high[k];
    }
    farthest = Math.max(farthest, distance);
    if (inside) square = Math.max(square, distance);
  }
  return { centre, radius: Math.sqrt(square), reach: Math.sqrt(farthest), size: high.map((v, k) => v - low[k]) };
}

/** Box: of all discs, each as far as it reaches along an axis; voxels from the middle. Widest: of all radii. */
function packPlaces(field, centre, texels) {
  const { points, positions, normals, mirrorNormals, radii, areas, centres, grid } = field;
  const means = field.meanColours(),
    low = [0, 0, 0].fill(points ? Infinity : 0),
    high = [0, 0, 0].fill(points ? -Infinity : 0);
  let widest = 0;
  const out = {
    places: new Uint32Array(4 * texels),
    directions: mirrorNormals && new Uint32Array(texels),
    means: new Uint8Array(4 * texels),
  };
  for (let p = 0; p < points; ++p) {
    const three = 3 * p,
      place = positions.subarray(three, three + 3),
      normal = normals.subarray(three, three + 3),
      radius = radii[p] / grid.step;
    let shift = 0;
    if (radius > widest) widest = radius;
    for (let k = 0; k < 3; ++k) {
      shift += (centres[three + k] - place[k]) * normal[k];
      out.means[4 * p + k] = means[three + k];
    }
    for (let k = 0; k < 3; ++k) {
      const at = place[k] - centre[k] + shift * normal[k],
        reach = radius * Math.sqrt(Math.max(0, 1 - normal[k] ** 2));
      if (at - reach < low[k]) low[k] = at - reach;
      if (at + reach > high[k]) high[k] = at + reach;
    }
    writeDisc(out.places, p, place, normal, shift, radius, areas[p] / radii[p] ** 2);
    if (mirrorNormals) out.directions[p] = toMirror(mirrorNormals[three], mirrorNormals[three + 1], mirrorNormals[three + 2]);
    out.means[4 * p + 3] = 255;
  }
  return { ...out, widest, box: [low, high] };
}
