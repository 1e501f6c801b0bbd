// SPDX-License-Identifier: Apache-2.0
// The reference reconstruction (spec annex E) in WebGL2, without any framework: colours of points,
// depths of discs, their weighted sums, the mean over what is behind.
import { bind, image, sample, target, use } from './gl_objects.js';
import { PointPipeline } from './point_pipeline.js';
import * as shaders from './shaders.js';

export class SurfelPipeline extends PointPipeline {
  constructor(gl) {
    super(gl, {
      depth: [shaders.DEPTH_VERTEX, shaders.DEPTH_FRAGMENT],
      blend: [shaders.BLEND_VERTEX, shaders.BLEND_FRAGMENT],
      resolve: [shaders.SCREEN_VERTEX, shaders.RESOLVE_FRAGMENT],
    });
  }

  ownTexels({ discs, directions }) {
    const { gl } = this;
    return { discs: [gl.RGBA32F, gl.RGBA, gl.FLOAT, discs], directions: [gl.RGBA32F, gl.RGBA, gl.FLOAT, directions] };
  }

  drawPoints(view, eye, share) {
    const { gl, field, sums, textures: t } = this;
    const drawn = Math.max(Math.min(1, field.points), Math.round(field.points * Math.min(1, share))); // none of an empty frame
    const distance = Math.hypot(...eye) - field.radius / field.step;
    this.nearest = 1.75 / Math.max(1, distance); // a disc's plane changes by 3/4 within it
    const set = (uniforms) => {
      this.setCamera(uniforms, view, eye);
      gl.uniform1f(uniforms.thinning, field.points / Math.max(1, drawn));
      gl.uniform1f(uniforms.nearest, this.nearest);
    };
    const own = { places: t.places, discs: t.discs, directions: t.directions, colours: t.colours, depth: sums.depth };
    gl.viewport(0, 0, view.width, view.height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, sums.depthTarget);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.GREATER);
    gl.depthMask(true);
    gl.clearDepth(0);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    this.drawQuads(this.programs.depth, own, set, drawn);

    gl.bindFramebuffer(gl.FRAMEBUFFER, sums.blendTarget);
    gl.disable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendEquationSeparate(gl.FUNC_ADD, gl.MAX);
    gl.blendFunc(gl.ONE, gl.ONE);
    gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 0]);
    gl.clearBufferfv(gl.COLOR, 1, [0, 0, 0, 0]);
    this.drawQuads(this.programs.blend, own, set, drawn);
    gl.disable(gl.BLEND);
    gl.blendEquation(gl.FUNC_ADD);
    this.statistics.discs = drawn;
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
    this.drawOver(viewport, depthRange);
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
    const depthTarget = target(gl, [], depth),
      blendTarget = target(gl, [weighted, weight], null);
    const textures = [depth, weighted, weight],
      targets = [depthTarget, blendTarget];
    this.sums = { width, height, depth, weighted, weight, depthTarget, blendTarget, textures, targets };
  }
}
