// SPDX-License-Identifier: Apache-2.0
// A decoded light field: arrays, colours, what a shader needs.
import { invalid, over, sideOf } from './slf_arguments.js';
import { DIRECTIONS, TRANSFERS } from './slf_headers.js';

const CHUNK_BYTES = 1 << 20; // of arrays on their way out

/** The arrays of slfw_read, by number. */
const POSITIONS = 0, COMPONENTS = 1, OCTAHEDRAL = 2, WEIGHTS = 3, MEANS = 4, MIRROR_NORMALS = 5,
  DISC_NORMALS = 6, DISC_CENTRES = 7, DISC_RADII = 8, DISC_AREAS = 9,
  SPLAT_COVARIANCES = 10, SPLAT_OPACITIES = 11;

/** A decoded light field in an instance of its own, until release(). Arrays handed out are copies. */
export class SlfField {
  #instance; #field; #done; #arrays = new Map();

  constructor(instance, field, info, done) {
    this.#instance = instance;
    this.#field = field;
    this.#done = done;
    instance.call((w) => { if (w.slfw_shape(field) !== 0) instance.fail(); });
    const [components, points, bits, partial, x, y, z, step, weights, directions, transfer, normals, gammaMin, gammaMax,
      splats] = instance.numbers(15);
    this.info = info;
    this.points = points;
    this.components = components;
    this.partial = partial !== 0;
    this.grid = { origin: [x, y, z], step, bits };
    this.functions = weights;
    this.directions = DIRECTIONS[directions];
    this.transfer = TRANSFERS[transfer];
    this.up = info.up;
    this.rightHanded = info.rightHanded;
    this.hasBasis = weights > 0;
    this.hasNormals = normals !== 0;
    this.hasSplats = splats !== 0;
    this.gamma = [gammaMin, gammaMax];
  }

  get positions() { return this.#cached(POSITIONS, () => this.#read(POSITIONS, Uint32Array, 3)); }
  get normals() { return this.#cached(DISC_NORMALS, () => this.#read(DISC_NORMALS, Float32Array, 3)); }
  get centres() { return this.#cached(DISC_CENTRES, () => this.#read(DISC_CENTRES, Float32Array, 3)); }
  get radii() { return this.#cached(DISC_RADII, () => this.#read(DISC_RADII, Float32Array, 1)); }
  get areas() { return this.#cached(DISC_AREAS, () => this.#read(DISC_AREAS, Float32Array, 1)); }
  get covariances() {
    if (!this.hasSplats) return null;
    return this.#cached(SPLAT_COVARIANCES, () => this.#read(SPLAT_COVARIANCES, Float32Array, 6));
  }
  get opacities() {
    return this.hasSplats ? this.#cached(SPLAT_OPACITIES, () => this.#read(SPLAT_OPACITIES, Float32Array, 1)) : null;
  }
  get octahedral() {
    return this.hasNormals ? this.#cached(OCTAHEDRAL, () => this.#read(OCTAHEDRAL, Uint16Array, 2)) : null;
  }
  get mirrorNormals() {
    if (!this.hasBasis || this.directions !== 'reflected') return null;
    return this.#cached(MIRROR_NORMALS, () => this.#read(MIRROR_NORMALS, Float32Array, 3));
  }
  get values() {
    return this.#cached(COMPONENTS, () => this.#narrow() ?? this.#read(COMPONENTS, Int32Array, 3 * this.components));
  }

  meanColours() { return this.#read(MEANS, Uint8Array, 3); }
  weights(out, first = 0, count = this.points - first) {
    if (!(Number.isInteger(first) && Number.isInteger(count) && first >= 0 && count >= 0 && first + count <= this.points))
      throw invalid('first and count', `must be whole numbers, of points from 0 to ${this.points}`);
    return this.#read(WEIGHTS, Float32Array, 3 * this.functions, out, first, count);
  }

  functionTable(options) {
    const side = sideOf(options);
    const layers = Math.ceil(this.functions / 4), floats = layers * 24 * side * side;
    return this.#call((w, instance) => {
      const at = instance.alloc(4 * floats);
      if (w.slfw_cube(this.#field, side, at, floats) !== 0) instance.fail();
      const data = new Float32Array(w.memory.buffer, at, floats).slice();
      return { size: side, side, layers, functions: this.functions, data };
    });
  }

  get kernel() {
    return this.#call((w, instance) => {
      w.slfw_kernel();
      const [version, filterPixels, exponent, spacingReach, leastReach, mostReach, smallest, core, band, steepest,
        flattest, discShare, densityGain, densityOffset] = instance.numbers(14);
      return { version, filterPixels, exponent, spacingReach, leastReach, mostReach, smallest, core, band, steepest,
        flattest, discShare, densityGain, densityOffset };
    });
  }

  radiance(points, directions) {
    if (!(directions?.length === 3 * points?.length)) throw invalid('directions', 'must be three numbers for every one of points');
    const indices = Uint32Array.from(points);
    if (!indices.every((index, i) => index === points[i])) throw invalid('points', `must be whole numbers, 0 to ${this.points - 1}`);
    return this.#call((w, instance) => {
      const from = instance.put(new Uint8Array(indices.buffer));
      const along = instance.put(new Uint8Array(Float32Array.from(directions).buffer));
      const to = instance.alloc(12 * points.length + 4);
      if (w.slfw_radiance(this.#field, points.length, from, along, to) !== 0) instance.fail();
      return new Float32Array(w.memory.buffer, to, 3 * points.length).slice();
    });
  }

  release() {
    if (this.#instance === null) return;
    if (!this.#instance.dead) this.#instance.wasm.slfw_release_field(this.#field);
    this.#done(this.#instance);
    this.#instance = null;
    this.#arrays.clear();
  }

  /** body(w, instance) */
  #call(body) {
    const instance = this.#instance;
    if (instance === null) throw over('the field was released');
    return instance.call((w) => body(w, instance));
  }

  #cached(key, make) {
    if (!this.#arrays.has(key)) this.#arrays.set(key, make());
    return this.#arrays.get(key);
  }

  /** read(first, count, at) for a few points at a time, so that the instance need not hold an array twice. */
  #chunks(rowBytes, use, from = 0, count = this.points) {
    return this.#call((w, instance) => {
      const most = Math.max(1, Math.floor(CHUNK_BYTES / Math.max(rowBytes, 1))), end = from + count;
      const at = instance.alloc(most * rowBytes + 4);
      let good = true;
      for (let first = from; good && first < end; first += most)
        good = use(w, first, Math.min(most, end - first), at);
      return good;
    });
  }

  #fetch(w, what, first, count, at) {
    if (w.slfw_read(this.#field, what, first, count, at) !== 0) this.#instance.fail();
  }

  #read(what, Type, width, out, from = 0, count = this.points) {
    out ??= new Type(count * width);
    if (!(out instanceof Type) || out.length < count * width)
      throw invalid('out', `must be a ${Type.name} of ${count * width} numbers or more`);
    this.#chunks(width * Type.BYTES_PER_ELEMENT, (w, first, some, at) => {
      this.#fetch(w, what, first, some, at);
      out.set(new Type(w.memory.buffer, at, some * width), (first - from) * width);
      return true;
    }, from, count);
    return out;
  }

  /** Components in 16 bits, or null where one does not fit. */
  #narrow() {
    const width = 3 * this.components, out = new Int16Array(this.points * width);
    const fits = this.#chunks(4 * width, (w, first, count, at) => {
      this.#fetch(w, COMPONENTS, first, count, at);
      if (w.slfw_narrow(at, at, count * width) === 0) return false;
      out.set(new Int16Array(w.memory.buffer, at, count * width), first * width);
      return true;
    });
    return fits ? out : null;
  }
}
