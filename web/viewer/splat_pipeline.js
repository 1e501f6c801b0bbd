// SPDX-License-Identifier: Apache-2.0
// Gaussian splats (spec annex E.6) in WebGL2: colours of splats, and the splats blended from the farthest to the
// nearest.
import { bind, image, putImage, sample, target, use } from './gl_objects.js';
import { PointPipeline } from './point_pipeline.js';
import { SCREEN_VERTEX } from './shaders.js';
import { SplatOrder } from './splat_order.js';
import { SPLAT_FRAGMENT, SPLAT_RESOLVE_FRAGMENT, SPLAT_VERTEX } from './splat_shaders.js';

export class SplatPipeline extends PointPipeline {
  constructor(gl) {
    super(gl, { splats: [SPLAT_VERTEX, SPLAT_FRAGMENT], resolve: [SCREEN_VERTEX, SPLAT_RESOLVE_FRAGMENT] });
    this.sorting = null;
  }

  ownTexels({ tails }) {
    const { gl } = this; // colours are not clamped from above
    return {
      tails: [gl.RG32UI, gl.RG_INTEGER, gl.UNSIGNED_INT, tails],
      colours: [gl.RGBA16F, gl.RGBA, gl.HALF_FLOAT, null],
      order: [gl.R32UI, gl.RED_INTEGER, gl.UNSIGNED_INT, null],
    };
  }

  upload(packed, images) {
    super.upload(packed, images);
    this.sorting = new SplatOrder(packed);
    this.ordered = new Uint32Array(packed.columns * packed.rows);
  }

  clearField() {
    super.clearField();
    this.sorting = this.ordered = null;
  }

  get unsettled() {
    return this.sorting !== null && !this.sorting.settled;
  }

  drawPoints(view, eye, share, { withDepth = false, patient = false, sameOrder = false }) {
    const { gl, field, sums, textures: t, sorting } = this;
    const drawn = Math.max(Math.min(1, field.points), Math.round(field.points * Math.min(1, share))); // none of an empty frame
    if (!(sameOrder && sorting.made) && sorting.towards(eye, view.rotation.slice(6), drawn, patient && sorting.made !== null)) this.putOrder();
    gl.viewport(0, 0, view.width, view.height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, sums.blendTarget);
    gl.disable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendEquation(gl.FUNC_ADD);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 0]);
    if (withDepth) gl.clearBufferfv(gl.COLOR, 1, [0, 0, 0, 0]);
    const own = { places: t.places, tails: t.tails, colours: t.colours, order: t.order };
    const set = (uniforms) => {
      this.setCamera(uniforms, view, eye);
      gl.uniform1f(uniforms.thinning, field.points / Math.max(1, drawn));
      gl.uniform1f(uniforms.nearest, field.nearest);
    };
    this.drawQuads(this.programs.splats, own, set, sorting.count);
    gl.disable(gl.BLEND);
    this.statistics.discs = sorting.count;
  }

  /** The rows of the texture that have splats of the order in them. */
  putOrder() {
    const { gl, field, ordered, sorting } = this,
      rows = Math.ceil(sorting.count / field.columns);
    if (rows === 0) return;
    ordered.set(sorting.order.subarray(0, sorting.count));
    putImage(gl, this.textures.order, field.columns, rows, gl.RED_INTEGER, gl.UNSIGNED_INT, ordered);
  }

  /** As SurfelPipeline's; a pixel's depth is the mean of what its splats show. */
  resolve({ viewport, exposure = 0, toLinear = false, depthRange = null }) {
    const { gl, sums, field } = this;
    if (!field || !sums) return;
    const uniforms = use(gl, this.programs.resolve);
    bind(gl, uniforms, { blended: sums.blended, depth: sums.depth ?? sums.blended });
    gl.uniform4fv(uniforms.viewport, viewport);
    gl.uniform1f(uniforms.nearest, field.nearest);
    gl.uniform1f(uniforms.exposure, 2 ** exposure);
    gl.uniform1i(uniforms.toLinear, toLinear ? 1 : 0);
    gl.uniform2fv(uniforms.depthRange, depthRange ?? [0, 0]);
    this.drawOver(viewport, depthRange);
  }

  prepareSums(width, height, { withDepth = false }) {
    const { gl } = this;
    if (this.sums?.width === width && this.sums.height === height && Boolean(this.sums.depth) === withDepth) return;
    this.clearSums();
    const blended = image(gl, gl.RGBA16F, width, height, gl.RGBA, gl.HALF_FLOAT, null);
    const depth = withDepth ? image(gl, gl.R16F, width, height, gl.RED, gl.HALF_FLOAT, null) : null;
    const textures = depth ? [blended, depth] : [blended];
    for (const texture of textures) {
      gl.bindTexture(gl.TEXTURE_2D, texture);
      sample(gl, gl.TEXTURE_2D, gl.LINEAR);
    }
    const blendTarget = target(gl, textures, null);
    this.sums = { width, height, blended, depth, blendTarget, textures, targets: [blendTarget] };
  }
}
