// The reference reconstruction (spec annex E) in WebGL2, without any framework: colours of points,
// depths of discs, their weighted sums, the mean over what is behind.
import { bind, image, layered, program, quadIndices, sample, target, use } from './gl_objects.js';
import * as shaders from './shaders.js';
import { ViewerError } from './packed_field.js';

const QUADS = 1 << 16; // of one draw: an index buffer for all draws

/**
 * @typedef {object} View  a camera with OpenCV axes (right, down, forward), as in cameras.json
 * @property {number} width, height  pixels
 * @property {number} fx, fy, cx, cy  pixels; the centre of the top left pixel is (0.5, 0.5)
 * @property {number[]} rotation  [9] rows right, down, forward, world to camera
 * @property {number[]} eye  [3] world
 */

export class SurfelPipeline {
  /**
   * @param {WebGL2RenderingContext} gl  whose state draw() and setField() change: see withState()
   * @throws {ViewerError} kind 'no-webgl2' where the device cannot blend half floats
   */
  constructor(gl) {
    this.gl = gl;
    if (!gl.getExtension('EXT_color_buffer_float') && !gl.getExtension('EXT_color_buffer_half_float'))
      throw new ViewerError('no-webgl2', 'This device cannot blend in half floats.');
    this.programs = {
      colour: program(gl, shaders.SCREEN_VERTEX, shaders.COLOUR_FRAGMENT),
      depth: program(gl, shaders.DEPTH_VERTEX, shaders.DEPTH_FRAGMENT),
      blend: program(gl, shaders.BLEND_VERTEX, shaders.BLEND_FRAGMENT),
      resolve: program(gl, shaders.SCREEN_VERTEX, shaders.RESOLVE_FRAGMENT),
    };
    this.nothing = gl.createVertexArray();
    this.quads = quadIndices(gl, QUADS);
    this.field = null;
    this.textures = {};
    this.sums = null;
    this.coloured = null;
    this.statistics = { discs: 0, colourFetches: 0 };
  }

  /** Uploads a light field in place of the one before. O(P R). @throws {ViewerError} 'too-large' */
  setField(packed) {
    const { gl } = this;
    const side = gl.getParameter(gl.MAX_TEXTURE_SIZE),
      layers = gl.getParameter(gl.MAX_ARRAY_TEXTURE_LAYERS);
    if (packed.rows > side || 3 * packed.layers > layers || packed.functions.width > side)
      throw new ViewerError(
        'too-large',
        `${packed.points} points with ${packed.components} components are more than this device's textures hold.`,
      );
    this.clearField();
    const { columns: w, rows: h } = packed,
      f = packed.functions;
    this.textures = {
      places: image(gl, gl.RGBA32F, w, h, gl.RGBA, gl.FLOAT, packed.places),
      discs: image(gl, gl.RGBA32F, w, h, gl.RGBA, gl.FLOAT, packed.discs),
      frames: image(gl, gl.RGBA32F, w, h, gl.RGBA, gl.FLOAT, packed.frames),
      means: image(gl, gl.RGBA8, w, h, gl.RGBA, gl.UNSIGNED_BYTE, packed.means),
      weights: layered(gl, gl.RGBA16I, w, h, 3 * packed.layers, gl.RGBA_INTEGER, gl.SHORT, packed.weights, gl.NEAREST),
      functions: layered(gl, gl.RGBA16F, f.width, f.height, f.layers, gl.RGBA, gl.FLOAT, f.texels, gl.LINEAR),
      colours: image(gl, gl.RGBA16F, w, h, gl.RGBA, gl.HALF_FLOAT, null),
    };
    this.colourTarget = target(gl, [this.textures.colours], null);
    if (gl.getError() === gl.OUT_OF_MEMORY)
      throw new ViewerError('too-large', 'The graphics memory does not hold this light field.');
    this.field = summary(packed);
    this.coloured = null;
  }

  clearField() {
    const { gl } = this;
    for (const texture of Object.values(this.textures)) gl.deleteTexture(texture);
    if (this.colourTarget) gl.deleteFramebuffer(this.colourTarget);
    this.textures = {};
    this.colourTarget = this.field = null;
  }

  /**
   * Depths, sums and coverage of a view, kept until the next call.
   * @param {View} view
   * @param {{meanOnly?: boolean, share?: number}} options  share: of the points, 0 .. 1
   */
  accumulate(view, { meanOnly = false, share = 1 } = {}) {
    const { gl, field } = this;
    if (!field) return;
    const eye = view.eye.map((x, k) => (x - field.centre[k]) / field.step);
    gl.disable(gl.SCISSOR_TEST);
    gl.disable(gl.STENCIL_TEST);
    gl.disable(gl.CULL_FACE);
    gl.colorMask(true, true, true, true);
    this.colourPoints(eye, meanOnly);
    this.prepareSums(view.width, view.height);
    this.drawDiscs(view, eye, share);
  }

  /** Colours of all points; none of the work where neither eye nor mode have changed. */
  colourPoints(eye, meanOnly) {
    const { gl, field, textures: t } = this;
    const key = `${eye} ${meanOnly}`;
    if (this.coloured === key) return;
    this.coloured = key;
    const uniforms = use(gl, this.programs.colour);
    bind(gl, uniforms, { places: t.places, frames: t.frames, means: t.means });
    bind(gl, uniforms, { weights: t.weights, functions: t.functions }, gl.TEXTURE_2D_ARRAY, 3);
    gl.uniform3fv(uniforms.eye, eye);
    gl.uniform2fv(uniforms.gamma, field.gamma);
    gl.uniform1i(uniforms.points, field.points);
    gl.uniform1i(uniforms.layers, field.layers);
    gl.uniform1f(uniforms.faceSize, field.faceSize);
    gl.uniform1i(uniforms.meanOnly, meanOnly ? 1 : 0);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.colourTarget);
    gl.viewport(0, 0, field.columns, field.rows);
    gl.disable(gl.BLEND);
    gl.disable(gl.DEPTH_TEST);
    this.drawScreen();
    this.statistics.colourFetches = meanOnly ? 1 : 2 + 4 * field.layers;
  }

  drawDiscs(view, eye, share) {
    const { gl, field, sums } = this;
    const drawn = Math.max(1, Math.round(field.points * Math.min(1, share)));
    const distance = Math.hypot(...eye) - field.radius / field.step;
    this.nearest = 1.75 / Math.max(1, distance); // a disc's plane changes by 3/4 within it
    const set = (uniforms) => {
      const r = view.rotation;
      gl.uniformMatrix3fv(uniforms.rotation, false, [r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]]);
      gl.uniform3fv(uniforms.eye, eye);
      gl.uniform2f(uniforms.focal, view.fx, -view.fy);
      gl.uniform2f(uniforms.centre, view.cx, view.height - view.cy);
      gl.uniform2f(uniforms.size, view.width, view.height);
      gl.uniform1f(uniforms.thinning, field.points / drawn);
      gl.uniform1f(uniforms.nearest, this.nearest);
    };
    gl.viewport(0, 0, view.width, view.height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, sums.depthTarget);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.GREATER);
    gl.depthMask(true);
    gl.clearDepth(0);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    this.drawQuads(this.programs.depth, set, drawn);

    gl.bindFramebuffer(gl.FRAMEBUFFER, sums.blendTarget);
    gl.disable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendEquationSeparate(gl.FUNC_ADD, gl.MAX);
    gl.blendFunc(gl.ONE, gl.ONE);
    gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 0]);
    gl.clearBufferfv(gl.COLOR, 1, [0, 0, 0, 0]);
    this.drawQuads(this.programs.blend, set, drawn);
    gl.disable(gl.BLEND);
    gl.blendEquation(gl.FUNC_ADD);
    this.statistics.discs = drawn;
  }

  drawQuads(program, set, drawn) {
    const { gl, textures: t } = this;
    const uniforms = use(gl, program);
    bind(gl, uniforms, {
      places: t.places,
      discs: t.discs,
      frames: t.frames,
      colours: t.colours,
      depth: this.sums.depth,
    });
    set(uniforms);
    gl.bindVertexArray(this.quads.array);
    for (let first = 0; first < drawn; first += QUADS) {
      gl.uniform1i(uniforms.first, first);
      gl.drawElements(gl.TRIANGLES, 6 * Math.min(QUADS, drawn - first), gl.UNSIGNED_INT, 0);
    }
  }

  /**
   * Draws what accumulate() has summed over the framebuffer that is bound, premultiplied.
   * @param {object} options  viewport [x, y, width, height]; exposure in stops; toLinear: the target
   *   wants linear light; depthRange: depth = x + y / (camera z in voxels); null: depth is left alone
   */
  resolve({ viewport, exposure = 0, toLinear = false, depthRange = null }) {
    const { gl, sums, field } = this;
    if (!field || !sums) return;
    const uniforms = use(gl, this.programs.resolve);
    bind(gl, uniforms, { weighted: sums.weighted, weight: sums.weight, depth: sums.depth });
    gl.uniform4fv(uniforms.viewport, viewport);
    gl.uniform1f(uniforms.nearest, this.nearest);
    gl.uniform1f(uniforms.exposure, 2 ** exposure);
    gl.uniform1i(uniforms.linear, field.linear ? 1 : 0);
    gl.uniform1i(uniforms.toLinear, toLinear ? 1 : 0);
    gl.uniform2fv(uniforms.depthRange, depthRange ?? [0, 0]);
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

  drawScreen() {
    this.gl.bindVertexArray(this.nothing);
    this.gl.drawArrays(this.gl.TRIANGLES, 0, 3);
  }

  prepareSums(width, height) {
    const { gl } = this;
    if (this.sums?.width === width && this.sums.height === height) return;
    this.clearSums();
    const depth = image(gl, gl.DEPTH_COMPONENT32F, width, height, gl.DEPTH_COMPONENT, gl.FLOAT, null);
    const weighted = image(gl, gl.RGBA16F, width, height, gl.RGBA, gl.HALF_FLOAT, null);
    const weight = image(gl, gl.R16F, width, height, gl.RED, gl.HALF_FLOAT, null);
    for (const texture of [weighted, weight]) {
      gl.bindTexture(gl.TEXTURE_2D, texture);
      sample(gl, gl.TEXTURE_2D, gl.LINEAR);
    }
    this.sums = {
      width,
      height,
      depth,
      weighted,
      weight,
      depthTarget: target(gl, [], depth),
      blendTarget: target(gl, [weighted, weight], null),
    };
  }

  clearSums() {
    const { gl, sums } = this;
    if (!sums) return;
    for (const texture of [sums.depth, sums.weighted, sums.weight]) gl.deleteTexture(texture);
    gl.deleteFramebuffer(sums.depthTarget);
    gl.deleteFramebuffer(sums.blendTarget);
    this.sums = null;
  }
}

/** What drawing needs of a packed light field; its texels are the device's now. */
export function summary(packed) {
  const { points, columns, rows, layers, components, gamma, linear, step, radius, centre, up, partial, levels } =
    packed;
  return {
    points,
    columns,
    rows,
    layers,
    components,
    gamma,
    linear,
    step,
    centre,
    up,
    partial,
    levels,
    radius,
    faceSize: packed.functions.faceSize,
    bytes: 4 * points * (4 + 4 + 4 + 1 + 2) + packed.weights.byteLength + packed.functions.texels.byteLength / 2,
  };
}
