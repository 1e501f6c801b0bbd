// A decoded light field as the texels that the pipeline uploads: no DOM, no WebGL, so that a worker
// does it.

const COLUMNS = 1024;

/** What stands in the way of a file that is sound: too large for the device, without view maps. */
export class ViewerError extends Error {
  /**
   * @param {'too-large'|'no-view-maps'|'no-webgl2'|'damaged'|'unsupported'|'network'|'memory'} kind
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
 * Texels of a light field, lengths in voxels from the middle of its box.
 * @param field  of SlfDecoder.decode()
 * @param {number} tableSize  samples along a side of a face of the function table
 * @returns {PackedField} typed arrays that can be transferred, and plain numbers
 */
export function packField(field, tableSize = 65) {
  const points = field.points,
    columns = Math.min(COLUMNS, Math.max(1, points));
  const rows = Math.max(1, Math.ceil(points / columns)),
    texels = columns * rows;
  const ball = boundingBall(field);
  const table = field.functionTable({ side: tableSize });
  const unit = packWeights(field.weights(), points, field.functions, texels);
  const packed = {
    points,
    columns,
    rows,
    components: field.components,
    layers: Math.ceil(field.functions / 4),
    weights: unit.texels,
    functions: packTable(table, unit.scales),
    gamma: Array.from(field.gamma),
    linear: field.transfer === 'linear',
    up: field.up,
    partial: Boolean(field.partial),
    levels: field.grid.bits,
    step: field.grid.step,
    radius: ball.radius * field.grid.step,
    size: ball.size.map((v) => v * field.grid.step),
    centre: ball.centre.map((c, k) => field.grid.origin[k] + field.grid.step * c),
    ...packPlaces(field, ball.centre, texels),
  };
  return packed;
}

/** Of all that can be transferred to another thread without a copy. */
export function buffersOf(packed) {
  return [packed.places, packed.discs, packed.frames, packed.means, packed.weights, packed.functions.texels].map(
    (array) => array.buffer,
  );
}

/** The middle of the box, as slf render has it, and the farthest point from there; voxels. */
function boundingBall({ positions }) {
  const low = [Infinity, Infinity, Infinity],
    high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; ++i) {
    const k = i % 3,
      v = positions[i];
    if (v < low[k]) low[k] = v;
    if (v > high[k]) high[k] = v;
  }
  if (!positions.length) return { centre: [0, 0, 0], radius: 1, size: [1, 1, 1] };
  const centre = low.map((v, k) => (v + high[k]) / 2);
  let square = 0;
  for (let i = 0; i < positions.length; i += 3)
    square = Math.max(
      square,
      (positions[i] - centre[0]) ** 2 + (positions[i + 1] - centre[1]) ** 2 + (positions[i + 2] - centre[2]) ** 2,
    );
  return { centre, radius: Math.sqrt(square), size: high.map((v, k) => v - low[k]) };
}

function packPlaces(field, centre, texels) {
  const { points, positions, normals, frameNormals, radii, areas, centres, grid } = field;
  const means = field.meanColours();
  const out = {
    places: new Float32Array(4 * texels),
    discs: new Float32Array(4 * texels),
    frames: new Float32Array(4 * texels),
    means: new Uint8Array(4 * texels),
  };
  for (let p = 0; p < points; ++p) {
    for (let k = 0; k < 3; ++k) {
      out.places[4 * p + k] = positions[3 * p + k] - centre[k];
      out.discs[4 * p + k] = normals[3 * p + k];
      if (frameNormals) out.frames[4 * p + k] = frameNormals[3 * p + k];
      out.means[4 * p + k] = means[3 * p + k];
      out.places[4 * p + 3] += (centres[3 * p + k] - positions[3 * p + k]) * normals[3 * p + k];
    }
    out.discs[4 * p + 3] = radii[p] / grid.step;
    out.frames[4 * p + 3] = areas[p] / radii[p] ** 2;
    out.means[4 * p + 3] = 255;
  }
  return out;
}

/**
 * Weights as shares of the greatest of their function, 16 bit: within 1/100 grey level of the mean.
 * @returns texels [3 L][rows][columns][4 functions], and the greatest weight of every function
 */
function packWeights(weights, points, components, texels) {
  const scales = new Float32Array(components);
  for (let i = 0, p = 0; p < points; ++p)
    for (let r = 0; r < components; ++r)
      for (let c = 0; c < 3; ++c, ++i) scales[r] = Math.max(scales[r], Math.abs(weights[i]));
  const factors = scales.map((s) => (s > 0 ? 32767 / s : 0));
  const out = new Int16Array(3 * Math.ceil(components / 4) * texels * 4);
  for (let i = 0, p = 0; p < points; ++p)
    for (let r = 0; r < components; ++r)
      for (let c = 0; c < 3; ++c, ++i)
        out[((3 * (r >> 2) + c) * texels + p) * 4 + (r & 3)] = Math.round(weights[i] * factors[r]);
  return { texels: out, scales };
}

/**
 * Faces three beside two, a layer for four functions.
 * Functions times the greatest weight of each over 255: a sum with shares of
 * 1 / 32767 is 0 .. 1.
 */
function packTable(table, scales) {
  const n = table.side,
    width = 3 * n,
    height = 2 * n;
  const out = new Float32Array(table.layers * width * height * 4);
  let from = 0;
  for (let layer = 0; layer < table.layers; ++layer)
    for (let face = 0; face < 6; ++face)
      for (let y = 0; y < n; ++y)
        for (let x = 0; x < n; ++x) {
          const column = (face % 3) * n + x,
            row = Math.floor(face / 3) * n + y;
          const to = ((layer * height + row) * width + column) * 4;
          for (let i = 0; i < 4; ++i, ++from) out[to + i] = (table.data[from] * (scales[4 * layer + i] ?? 0)) / 255;
        }
  return { texels: out, width, height, layers: table.layers, faceSize: n };
}
