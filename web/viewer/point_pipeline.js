// SPDX-License-Identifier: Apache-2.0
// What pipelines of points share: the texels of a light field on the device, and the colours of its points from
// a place.
import { bind, image, layered, program, putImage, putLayers, quadIndices, target, use } from './gl_objects.js';
import { COLOUR_FRAGMENT, SCREEN_VERTEX } from './shaders.js';
import { ViewerError } from './packed_field.js';

const QUADS = 1 << 16; // of one draw: an index buffer for all draws
const SPARE = 1 / 8; // of the rows of a frame, for those of the frames behind it

/**
 * @typedef {object} View  a camera with OpenCV axes (right, down, forward), as in cameras.json
 * @property {number} width, height  pixels
 * @property {number} fx, fy, cx, cy  pixels; the centre of the top left pixel is (0.5, 0.5)
 * @property {number[]} rotation  [9] rows right, down, forward, world to camera
 * @property {number[]} eye  [3] world
 */

/** Of a kind of points that says what its own texels are (ownTexels) and how they are drawn (drawPoints, resolve). */
export class PointPipeline {
  /**
   * @param {WebGL2RenderingContext} gl  whose state draw() and setField() change: see withState()
   * @param {object} programs  vertex and fragment shader of each
   * @throws {ViewerError} kind 'no-webgl2' where the device cannot blend half floats
   */
  constructor(gl, programs) {
    this.gl = gl;
    if (!gl.getExtension('EXT_color_buffer_float') && !gl.getExtension('EXT_color_buffer_half_float'))
      throw new ViewerError('no-webgl2', 'This device cannot blend in half floats.');
    this.programs = { colour: program(gl, SCREEN_VERTEX, COLOUR_FRAGMENT) };
    for (const [name, shaders] of Object.entries(programs)) this.programs[name] = program(gl, ...shaders);
    this.nothing = gl.createVertexArray();
    this.quads = quadIndices(gl, QUADS);
    this.field = this.allocated = null;
    this.textures = {};
    this.sums = null;
    this.coloured = null;
    this.statistics = { discs: 0, colourFetches: 0 };
  }

  /** Uploads a light field in place of the one before: a frame into its textures, where it fits. O(P R). @throws {ViewerError} 'too-large' */
  setField(packed) {
    const { gl } = this;
    const side = gl.getParameter(gl.MAX_TEXTURE_SIZE),
      layers = gl.getParameter(gl.MAX_ARRAY_TEXTURE_LAYERS);
    if (packed.rows > side || Math.max(packed.layers, packed.weightLayers) > layers || packed.functions.width > side)
      throw new ViewerError(
        'too-large',
        `${packed.points} points with ${packed.components} components are more than this device's textures hold.`,
      );
    const images = this.imagesOf(packed);
    if (!this.holds(packed)) this.allocate(packed, images);
    this.upload(packed, images);
    if (gl.getError() === gl.OUT_OF_MEMORY)
      throw new ViewerError('too-large', 'The graphics memory does not hold this light field.');
    this.field = summary(packed);
    this.coloured = null;
  }

  /** Of each texture [columns][rows]: internal format, format, type, texels. */
  imagesOf(packed) {
    const { gl } = this;
    return {
      places: [gl.RGBA32UI, gl.RGBA_INTEGER, gl.UNSIGNED_INT, packed.places],
      means: [gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, packed.means],
      ...this.ownTexels(packed),
    };
  }

  /** Whether a frame fits into the textures of the one before. */
  holds({ columns, rows, weightLayers, directions, functions: f, moving }) {
    const has = this.allocated;
    return Boolean(moving && has && has.columns === columns && has.rows >= rows && has.weightLayers === weightLayers
      && !directions === !this.textures.directions
      && has.width === f.width && has.height === f.height && has.functionLayers === f.layers);
  }

  allocate({ columns, rows, weightLayers, functions: f, moving }, images) {
    const { gl } = this,
      most = Math.min(gl.getParameter(gl.MAX_TEXTURE_SIZE), rows + (moving ? Math.ceil(SPARE * rows) : 0));
    this.clearField();
    for (const [name, [internal, format, type]] of Object.entries(images))
      this.textures[name] = image(gl, internal, columns, most, format, type, null);
    this.textures.weights = layered(gl, gl.RGBA32UI, columns, most, weightLayers, gl.NEAREST);
    this.textures.functions = layered(gl, gl.RGBA16F, f.width, f.height, f.layers, gl.LINEAR);
    this.colourTarget = target(gl, [this.textures.colours], null);
    this.allocated = { columns, rows: most, weightLayers, width: f.width, height: f.height, functionLayers: f.layers, uploaded: null };
  }

  upload({ columns, rows, weightLayers, weights, functions: f, moving }, images) {
    const { gl, textures: t } = this;
    for (const [name, [, format, type, texels]] of Object.entries(images))
      if (texels) putImage(gl, t[name], columns, rows, format, type, texels);
    putLayers(gl, t.weights, columns, rows, weightLayers, gl.RGBA_INTEGER, gl.UNSIGNED_INT, weights);
    if (moving && this.allocated.uploaded === f.key) return;
    putLayers(gl, t.functions, f.width, f.height, f.layers, gl.RGBA, gl.HALF_FLOAT, f.texels);
    this.allocated.uploaded = f.key;
  }

  clearField() {
    const { gl } = this;
    for (const texture of Object.values(this.textures)) gl.deleteTexture(texture);
    if (this.colourTarget) gl.deleteFramebuffer(this.colourTarget);
    this.textures = {};
    this.colourTarget = this.field = this.allocated = null;
  }

  /**
   * Depths, sums and coverage of a view, kept until the next call.
   * @param {View} view
   * @param {object} options  meanOnly; share: of the points, 0 .. 1; withDepth: resolve() will be asked for depths;
   *   patient: what takes long may be that of a view before, and `unsettled` says so; sameOrder: splats lie as in the view
   *   before, that of the other eye
   */
  accumulate(view, { meanOnly = false, share = 1, ...options } = {}) {
    const { gl, field } = this;
    if (!field) return;
    const eye = view.eye.map((x, k) => (x - field.centre[k]) / field.step);
    gl.disable(gl.SCISSOR_TEST);
    gl.disable(gl.STENCIL_TEST);
    gl.disable(gl.CULL_FACE);
    gl.colorMask(true, true, true, true);
    this.colourPoints(eye, meanOnly);
    this.prepareSums(view.width, view.height, options);
    this.drawPoints(view, eye, share, options);
  }

  /** Whether a later frame of the same view would be another. */
  get unsettled() {
    return false;
  }

  /** Colours of all points; none of the work where neither eye nor mode have changed. */
  colourPoints(eye, meanOnly) {
    const { gl, field, textures: t } = this;
    const key = `${eye} ${meanOnly}`;
    if (this.coloured === key) return;
    this.coloured = key;
    const uniforms = use(gl, this.programs.colour);
    // Samplers of a kind share a unit with others of it, where there is no texture of their own.
    bind(gl, uniforms, { places: t.places, directions: t.directions ?? t.places, means: t.means });
    bind(gl, uniforms, { weights: t.weights, functions: t.functions }, gl.TEXTURE_2D_ARRAY, 3);
    gl.uniform3fv(uniforms.middle, field.middle);
    gl.uniform3fv(uniforms.eye, eye);
    gl.uniform2fv(uniforms.gamma, field.gamma);
    gl.uniform1i(uniforms.points, field.points);
    gl.uniform1i(uniforms.layers, field.layers);
    gl.uniform1i(uniforms.fine, field.fine);
    gl.uniform1i(uniforms.mirrored, t.directions ? 1 : 0);
    gl.uniform1i(uniforms.rooted, field.linear && !field.splats ? 1 : 0);
    gl.uniform1f(uniforms.faceSize, field.faceSize);
    gl.uniform1i(uniforms.meanOnly, meanOnly ? 1 : 0);
    gl.uniform1f(uniforms.brightest, field.brightest);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.colourTarget);
    gl.viewport(0, 0, field.columns, field.rows);
    gl.disable(gl.BLEND);
    gl.disable(gl.DEPTH_TEST);
    this.drawScreen();
    this.statistics.colourFetches = meanOnly ? 1 : fetchesOf(field, t);
  }

  /** The camera of a view, for a vertex shader of points. */
  setCamera(uniforms, view, eye) {
    const { gl } = this,
      r = view.rotation;
    gl.uniformMatrix3fv(uniforms.rotation, false, [r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]]);
    gl.uniform3fv(uniforms.middle, this.field.middle);
    gl.uniform3fv(uniforms.eye, eye);
    gl.uniform2f(uniforms.focal, view.fx, -view.fy);
    gl.uniform2f(uniforms.centre, view.cx, view.height - view.cy);
    gl.uniform2f(uniforms.size, view.width, view.height);
  }

  /** @param set  (uniforms) => sets what the program has beside textures */
  drawQuads(program, textures, set, drawn) {
    const { gl } = this;
    const uniforms = use(gl, program);
    bind(gl, uniforms, textures);
    set(uniforms);
    gl.bindVertexArray(this.quads.array);
    for (let first = 0; first < drawn; first += QUADS) {
      gl.uniform1i(uniforms.first, first);
      gl.drawElements(gl.TRIANGLES, 6 * Math.min(QUADS, drawn - first), gl.UNSIGNED_INT, 0);
    }
  }

  drawScreen() {
    this.gl.bindVertexArray(this.nothing);
    this.gl.drawArrays(this.gl.TRIANGLES, 0, 3);
  }

  /** State of a picture that is laid over the framebuffer that is bound, premultiplied. */
  drawOver(viewport, depthRange) {
    const { gl } = this;
    gl.viewport(...viewport);
    gl.enable(gl.BLEND);
    gl.blendEquation(gl.FUNC_ADD);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    if (depthRange) {
      gl.enable(gl.DEPTH_TEST);
      gl.depthFunc(gl.LEQUAL);
      gl.depthMask(true);
    } else {
      gl.disable(gl.DEPTH_TEST);
      gl.depthMask(false);
    }
    this.drawScreen();
  }

  dispose() {
    const { gl } = this;
    this.clearField();
    this.clearSums();
    for (const { program } of Object.values(this.programs)) gl.deleteProgram(program);
    gl.deleteVertexArray(this.nothing);
    gl.deleteVertexArray(this.quads.array);
    gl.deleteBuffer(this.quads.buffer);
  }

  clearSums() {
    const { gl, sums } = this;
    if (!sums) return;
    for (const texture of sums.textures) gl.deleteTexture(texture);
    for (const buffer of sums.targets) gl.deleteFramebuffer(buffer);
    this.sums = null;
  }
}

/** Texels that the colour of a point takes: its own, and those of its weights and functions. */
const fetchesOf = ({ layers, weightLayers, fine }, { directions }) => (directions ? 2 : 1) + layers + weightLayers + fine;

/** What drawing needs of a packed light field; its texels are the device's now. */
export function summary(packed) {
  const { points, columns, rows, layers, weightLayers, fine, components, gamma, linear, step, middle, radius, centre } = packed,
    { up, partial, levels, splats, nearest, places, directions, tails, means, weights, functions, widest, reach } = packed;
  const held = [places, directions, tails, means, weights, functions.texels].reduce((sum, each) => sum + (each?.byteLength ?? 0), 0);
  return {
    points,
    columns,
    rows,
    layers,
    weightLayers,
    fine,
    components,
    gamma,
    linear,
    step,
    middle,
    centre,
    up,
    partial,
    levels,
    radius,
    splats,
    widest,
    reach,
    nearest,
    brightest: splats ? 65504 : 1, // of a colour, display white 1: the most of a half float
    faceSize: functions.faceSize,
    bytes: held + columns * rows * (splats ? 12 : 4), // with colours, and the order of splats
  };
}
