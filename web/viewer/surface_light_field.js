// SPDX-License-Identifier: Apache-2.0
// A light field as an object of a three.js scene. It has the picture of `slf render` from wherever the
// scene's camera is, hides what is behind it and is hidden by what is before it.
import {
  Box3,
  BufferAttribute,
  BufferGeometry,
  Color,
  LinearSRGBColorSpace,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  Ray,
  Sphere,
  SRGBColorSpace,
  Vector3,
  Vector4,
} from 'three';
import { colourFrom, pick } from './pick.js';
import { pipelineWith } from './pipelines.js';
import { viewOfCamera } from './view.js';

const viewport = new Vector4(),
  toObject = new Matrix4(),
  ray = new Ray(),
  place = new Vector3();

/**
 * Draws with WebGLRenderer. Moves, turns and scales (evenly) like any object; materials, lamps, shadows, fog and tone
 * mapping do not apply: the light it was photographed in is in it. Blended after opaque objects.
 *
 * meanOnly: without what depends on the view; exposure: stops; share: of the points, 0 .. 1.
 * One renderer at a time: another gets its own copy of the textures when it draws first. Clones share them.
 */
export class SurfaceLightField extends Mesh {
  /**
   * @param packed  of packField(); kept, so that a lost context can be filled again and rays can meet it
   * @param shared  of a clone: what draws its original
   */
  constructor(packed, info = {}, shared = { pipelines: new Map(), users: 0 }) {
    super(geometryOf(packed), new MeshBasicMaterial({ transparent: true, depthWrite: false, colorWrite: false }));
    this.isSurfaceLightField = true;
    this.type = 'SurfaceLightField';
    this.info = info;
    this.packed = packed;
    this.meanOnly = false;
    this.exposure = 0;
    this.share = 1;
    this.shared = shared;
    this.disposed = false;
    ++shared.users;
    this.onBeforeRender = this.draw;
  }

  get pipelines() {
    return this.shared.pipelines;
  }

  /** Another of the same texels: graphics memory does not grow. */
  clone(recursive = true) {
    return new this.constructor(this.packed, this.info, this.shared).copy(this, recursive);
  }

  copy(source, recursive) {
    const { geometry, material } = this;
    super.copy(source, recursive);
    const { meanOnly, exposure, share } = source;
    return Object.assign(this, { geometry, material, meanOnly, exposure, share });
  }

  /**
   * For Raycaster: the surface that is drawn where the ray meets it. Besides distance, point and object: index of the
   * point, normal (in the object's axes, to the ray's origin), color (three's Color: what is seen along the ray).
   */
  raycast(raycaster, intersections) {
    const { packed } = this,
      { step, centre } = packed;
    ray.copy(raycaster.ray).applyMatrix4(toObject.copy(this.matrixWorld).invert());
    if (!ray.intersectsSphere(this.geometry.boundingSphere)) return;
    ray.direction.normalize();
    const from = ray.origin.toArray().map((x, k) => (x - centre[k]) / step);
    const met = pick(packed, from, ray.direction.toArray(), this.share);
    if (!met) return;
    const point = ray.at(met.distance * step, new Vector3()).applyMatrix4(this.matrixWorld),
      distance = raycaster.ray.origin.distanceTo(point);
    if (distance < raycaster.near || distance > raycaster.far) return;
    const normal = new Vector3(...met.normal);
    intersections.push({
      distance,
      point,
      object: this,
      index: met.index,
      normal,
      face: { a: met.index, b: met.index, c: met.index, normal, materialIndex: 0 },
      color: this.colourOf(met.index, ray.origin),
    });
  }

  /** What is seen of a point from a place in the object's axes. @returns {Color} */
  colourOf(index, eye) {
    const { step, centre, linear } = this.packed;
    const rgb = colourFrom(this.packed, index, place.copy(eye).toArray().map((x, k) => (x - centre[k]) / step), this.meanOnly);
    const colour = new Color().setRGB(...rgb, linear ? LinearSRGBColorSpace : SRGBColorSpace);
    return this.exposure === 0 ? colour : colour.multiplyScalar(2 ** this.exposure);
  }

  draw(renderer, scene, camera) {
    const gl = renderer.getContext(),
      pipeline = this.pipelineOf(gl);
    const target = renderer.getRenderTarget();
    renderer.getCurrentViewport(viewport);
    const [x, y, width, height] = viewport.toArray().map(Math.round);
    if (!(width > 0 && height > 0)) return;
    toObject.copy(this.matrixWorld).invert().multiply(camera.matrixWorld);
    const { view, scale } = viewOfCamera(camera.projectionMatrix.elements, toObject.elements, width, height);
    withState(gl, () => {
      pipeline.accumulate(view, { meanOnly: this.meanOnly, share: this.share, withDepth: true });
    });
    withState(gl, () => {
      // WebGL itself encodes what is drawn into any other sRGB target.
      const linear = target !== null && !(target.isXRRenderTarget === true && target.texture.colorSpace === 'srgb');
      pipeline.resolve({
        viewport: [x, y, width, height],
        exposure: this.exposure,
        toLinear: linear,
        depthRange: depthRange(camera.projectionMatrix.elements, scale * this.packed.step),
      });
    });
  }

  pipelineOf(gl) {
    if (this.disposed) ++this.shared.users;
    this.disposed = false;
    let own = this.pipelines.get(gl);
    if (own && !own.lost) {
      if (own.failure) throw own.failure;
      return own;
    }
    withState(gl, () => {
      own = pipelineOrFailure(gl, this.packed);
    });
    gl.canvas.addEventListener(
      'webglcontextlost',
      () => {
        own.lost = true;
      },
      { once: true },
    );
    this.pipelines.set(gl, own);
    if (own.failure) throw own.failure;
    return own;
  }

  /** Textures go with the last of the clones. It can be drawn again. */
  dispose() {
    this.geometry.dispose();
    this.material.dispose();
    if (!this.disposed) --this.shared.users;
    this.disposed = true;
    if (this.shared.users > 0) return;
    for (const pipeline of this.pipelines.values()) if (!pipeline.lost) pipeline.dispose?.();
    this.pipelines.clear();
  }
}

/** What three asks for bounds: a box of all discs, whose corners are all that it has. None of it is drawn. */
function geometryOf({ box: [low, high], centre, reach, step }) {
  const corners = Array.from({ length: 8 }, (_, i) => [0, 1, 2].map((k) => ((i >> k) & 1 ? high : low)[k]));
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(corners.flat()), 3));
  geometry.setDrawRange(0, 3);
  geometry.boundingBox = new Box3(new Vector3(...low), new Vector3(...high));
  geometry.boundingSphere = new Sphere(new Vector3(...centre), reach + 2 * step);
  geometry.computeBoundingBox = geometry.computeBoundingSphere = () => {};
  return geometry;
}

/** A pipeline with a field, or why there is none: the next frame need not try again. */
function pipelineOrFailure(gl, packed) {
  try {
    return pipelineWith(gl, packed);
  } catch (failure) {
    return { failure };
  }
}

/** Depth in the frame buffer is x + y / z, z in voxels; `voxel` in the camera's units. */
function depthRange(p, voxel) {
  // clip z over w of a point z before the camera: (-p[10] z + p[14]) / z
  return [0.5 - 0.5 * p[10], (0.5 * p[14]) / voxel];
}

const FLAGS = ['BLEND', 'DEPTH_TEST', 'CULL_FACE', 'SCISSOR_TEST', 'STENCIL_TEST'];
const UNITS = 6;

/** Calls `draw` and leaves WebGL as it was, so that three's own record of it stays true. */
export function withState(gl, draw) {
  const get = (name) => gl.getParameter(gl[name]);
  const flags = FLAGS.map((name) => gl.isEnabled(gl[name]));
  const unit = get('ACTIVE_TEXTURE');
  const textures = Array.from({ length: UNITS }, (_, i) => {
    gl.activeTexture(gl.TEXTURE0 + i);
    return [get('TEXTURE_BINDING_2D'), get('TEXTURE_BINDING_2D_ARRAY'), get('SAMPLER_BINDING')];
  });
  for (let i = 0; i < UNITS; ++i) gl.bindSampler(i, null);
  const saved = Object.fromEntries(
    [
      'CURRENT_PROGRAM',
      'VERTEX_ARRAY_BINDING',
      'DRAW_FRAMEBUFFER_BINDING',
      'READ_FRAMEBUFFER_BINDING',
      'VIEWPORT',
      'BLEND_EQUATION_RGB',
      'BLEND_EQUATION_ALPHA',
      'BLEND_SRC_RGB',
      'BLEND_DST_RGB',
      'BLEND_SRC_ALPHA',
      'BLEND_DST_ALPHA',
      'DEPTH_FUNC',
      'DEPTH_WRITEMASK',
      'DEPTH_CLEAR_VALUE',
      'COLOR_WRITEMASK',
      'COLOR_CLEAR_VALUE',
      'PIXEL_UNPACK_BUFFER_BINDING',
      'UNPACK_ALIGNMENT',
      'UNPACK_FLIP_Y_WEBGL',
      'UNPACK_PREMULTIPLY_ALPHA_WEBGL',
    ].map((name) => [name, get(name)]),
  );
  try {
    draw();
  } finally {
    restore(gl, saved);
    FLAGS.forEach((name, i) => (flags[i] ? gl.enable(gl[name]) : gl.disable(gl[name])));
    textures.forEach(([plain, array, sampler], i) => {
      gl.activeTexture(gl.TEXTURE0 + i);
      gl.bindTexture(gl.TEXTURE_2D, plain);
      gl.bindTexture(gl.TEXTURE_2D_ARRAY, array);
      gl.bindSampler(i, sampler);
    });
    gl.activeTexture(unit);
  }
}

function restore(gl, s) {
  gl.useProgram(s.CURRENT_PROGRAM);
  gl.bindVertexArray(s.VERTEX_ARRAY_BINDING);
  gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, s.DRAW_FRAMEBUFFER_BINDING);
  gl.bindFramebuffer(gl.READ_FRAMEBUFFER, s.READ_FRAMEBUFFER_BINDING);
  gl.viewport(...s.VIEWPORT);
  gl.blendEquationSeparate(s.BLEND_EQUATION_RGB, s.BLEND_EQUATION_ALPHA);
  gl.blendFuncSeparate(s.BLEND_SRC_RGB, s.BLEND_DST_RGB, s.BLEND_SRC_ALPHA, s.BLEND_DST_ALPHA);
  gl.depthFunc(s.DEPTH_FUNC);
  gl.depthMask(s.DEPTH_WRITEMASK);
  gl.clearDepth(s.DEPTH_CLEAR_VALUE);
  gl.colorMask(...s.COLOR_WRITEMASK);
  gl.clearColor(...s.COLOR_CLEAR_VALUE);
  gl.bindBuffer(gl.PIXEL_UNPACK_BUFFER, s.PIXEL_UNPACK_BUFFER_BINDING);
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, s.UNPACK_ALIGNMENT);
  gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, s.UNPACK_FLIP_Y_WEBGL);
  gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, s.UNPACK_PREMULTIPLY_ALPHA_WEBGL);
}
