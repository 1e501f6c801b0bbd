// SPDX-License-Identifier: Apache-2.0
// The reference reconstruction (spec annex E) in WebGL2, without any framework: colours of points,
// depths of discs, their weighted sums, the mean over what is behind.
import { bind, image, sample, target, use } from './gl_objects.js';
import { BLOCK, BLOCK_FRAGMENT, OCCLUDER_FRAGMENT } from './occluder_shaders.js';
import { PointPipeline } from './point_pipeline.js';
import * as shaders from './shaders.js';

const LARGEST_SPRITE = 32; // pixels; sides of larger discs differ by more pixels than corners are worth

const blocksOf = (...sides) => sides.map((side) => Math.ceil(side / BLOCK));

export class SurfelPipeline extends PointPipeline {
  constructor(gl) {
    super(gl, {
      depth: [shaders.depthVertex('quads'), shaders.DEPTH_FRAGMENT],
      depthSprites: [shaders.depthVertex('sprites'), shaders.DEPTH_FRAGMENT],
      blend: [shaders.blendVertex('quads'), shaders.BLEND_FRAGMENT],
      blendSprites: [shaders.blendVertex('sprites'), shaders.BLEND_FRAGMENT],
      occluders: [shaders.SCREEN_VERTEX, OCCLUDER_FRAGMENT],
      blocks: [shaders.SCREEN_VERTEX, BLOCK_FRAGMENT],
      resolve: [shaders.SCREEN_VERTEX, shaders.RESOLVE_FRAGMENT],
    });
    const widest = gl.getParameter(gl.ALIASED_POINT_SIZE_RANGE)[1];
    this.largestSprite = widest < LARGEST_SPRITE ? 0 : LARGEST_SPRITE;
  }

  ownTexels({ directions }) {
    const { gl } = this,
      own = { colours: [gl.RGB10_A2, gl.RGBA, gl.UNSIGNED_INT_2_10_10_10_REV, null] };
    if (directions) own.directions = [gl.R32UI, gl.RED_INTEGER, gl.UNSIGNED_INT, directions];
    return own;
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
      gl.uniform1i(uniforms.rooted, field.linear ? 1 : 0);
      gl.uniform1f(uniforms.largestSprite, this.largestSprite);
    };
    const draw = (name) => {
      if (this.largestSprite > 0) this.drawSprites(this.programs[`${name}Sprites`], own, set, drawn);
      if (!this.allSprites(view, eye, field.points / Math.max(1, drawn))) this.drawQuads(this.programs[name], own, set, drawn);
    };
    const own = { places: t.places, colours: t.colours, depth: sums.depth, blocks: sums.blocks };
    gl.viewport(0, 0, view.width, view.height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, sums.depthTarget);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.GREATER);
    gl.depthMask(true);
    gl.clearDepth(0);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    draw('depth');
    this.findOccluders(view);

    gl.viewport(0, 0, view.width, view.height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, sums.blendTarget);
    gl.depthFunc(gl.GREATER);
    gl.depthMask(false);
    gl.enable(gl.BLEND);
    gl.blendEquationSeparate(gl.FUNC_ADD, gl.MAX);
    gl.blendFunc(gl.ONE, gl.ONE);
    gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 0]);
    gl.clearBufferfv(gl.COLOR, 1, [0, 0, 0, 0]);
    draw('blend');
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    gl.blendEquation(gl.FUNC_ADD);
    this.statistics.discs = drawn;
  }

  /** Depths of pixels, and of blocks of them, behind which nothing shows. */
  findOccluders({ width, height }) {
    const { gl, sums, programs } = this;
    gl.depthFunc(gl.ALWAYS);
    const pass = (program, target, textures, ...sides) => {
      gl.viewport(0, 0, ...sides);
      gl.bindFramebuffer(gl.FRAMEBUFFER, target);
      bind(gl, use(gl, program), textures);
      this.drawScreen();
    };
    pass(programs.occluders, sums.occluderTarget, { depth: sums.depth }, width, height);
    pass(programs.blocks, sums.blockTarget, { occluders: sums.occluders }, ...blocksOf(width, height));
  }

  drawSprites(program, textures, set, drawn) {
    const { gl } = this,
      uniforms = use(gl, program);
    bind(gl, uniforms, textures);
    set(uniforms);
    gl.uniform1i(uniforms.first, 0);
    gl.bindVertexArray(this.nothing);
    gl.drawArrays(gl.POINTS, 0, drawn);
  }

  /** Whether every disc of a view is a sprite: the ball of all is in the picture, and the widest would be no wider. */
  allSprites({ width, height, fx, fy, cx, cy, rotation }, eye, thinning) {
    const { widest, reach, step } = this.field,
      ball = reach / step + 1,
      radius = widest * Math.sqrt(thinning),
      [x, y, z] = [0, 3, 6].map((row) => -rotation[row] * eye[0] - rotation[row + 1] * eye[1] - rotation[row + 2] * eye[2]),
      near = z - ball;
    const within = (along, focal, side) => focal * along + side * z > ball * Math.hypot(focal, side);
    const inside = within(x, fx, cx) && within(x, -fx, width - cx) && within(y, fy, cy) && within(y, -fy, height - cy);
    if (!(near > radius && inside)) return false;
    const slant = 1 + (Math.max(cx, width - cx) / fx) ** 2 + (Math.max(cy, height - cy) / fy) ** 2;
    return 2 * radius * (Math.max(fx, fy) / near) * slant + 5 < this.largestSprite;
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
    const [depth, occluders, blocks] = [[width, height], [width, height], blocksOf(width, height)].map((sides) =>
      image(gl, gl.DEPTH_COMPONENT32F, ...sides, gl.DEPTH_COMPONENT, gl.FLOAT, null),
    );
    const weighted = image(gl, gl.RGBA16F, width, height, gl.RGBA, gl.HALF_FLOAT, null);
    const weight = image(gl, gl.R16F, width, height, gl.RED, gl.HALF_FLOAT, null);
    for (const texture of [weighted, weight]) {
      gl.bindTexture(gl.TEXTURE_2D, texture);
      sample(gl, gl.TEXTURE_2D, gl.LINEAR);
    }
    const [depthTarget, occluderTarget, blockTarget] = [depth, occluders, blocks].map((each) => target(gl, [], each)),
      blendTarget = target(gl, [weighted, weight], occluders);
    const textures = [depth, occluders, blocks, weighted, weight],
      targets = [depthTarget, occluderTarget, blockTarget, blendTarget];
    this.sums = { width, height, depth, occluders, blocks, weighted, weight, depthTarget, occluderTarget, blockTarget, blendTarget, textures, targets };
  }
}
