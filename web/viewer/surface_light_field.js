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
import { withState } from './gl_state.js';
import { LightFieldMotion } from './light_field_motion.js';
import { colourFrom, pick } from './pick.js';
import { pipelineWith } from './pipelines.js';
import { viewOfCamera } from './view.js';

export { withState };

const viewport = new Vector4(),
  toObject = new Matrix4(),
  ray = new Ray(),
  place = new Vector3();

/**
 * Draws with WebGLRenderer. Moves, turns and scales (evenly) like any object; materials, lamps, shadows, fog and tone
 * mapping do not apply: the light it was photographed in is in it. Blended after opaque objects.
 *
 * meanOnly: without what depends on the view; exposure: stops; share: of the points, 0 .. 1.
 * One renderer at a time: another gets its own copy of the textures when it draws first. Clones share them, and the
 * frame that shows.
 */
export class SurfaceLightField extends Mesh {
  /**
   * @param packed  of packField(); kept, so that a lost context can be filled again and rays can meet it
   * @param shared  of a clone: what it has in common with its original
   */
  constructor(packed, info = {}, shared = sharedOf(packed, info)) {
    super(shared.geometry, new MeshBasicMaterial({ transparent: true, depthWrite: false, colorWrite: false }));
    this.isSurfaceLightField = true;
    this.type = 'SurfaceLightField';
    this.meanOnly = false;
    this.exposure = 0;
    this.share = 1;
    this.shared = shared;
    this.disposed = true;
    this.join();
    this.onBeforeRender = this.draw;
  }

  /**
   * One that moves.
   * @param first  {packed, info} of its first frame
   * @param source  FrameSource of all  @param {() => void} end  ends what decodes them
   */
  static moving({ packed, info }, source, end) {
    const field = new SurfaceLightField(packed, info),
      { shared } = field;
    shared.motion = new LightFieldMotion(source, (frame) => showFrame(shared, frame), end);
    shared.motion.objects.add(field);
    return field;
  }

  /** What shows now. */
  get packed() { return this.shared.packed; }
  get info() { return this.shared.info; }

  get pipelines() {
    return this.shared.pipelines;
  }

  // What moves: the names of <slf-viewer>, and update() and setTime() of three's AnimationMixer. All but update() are
  // of all clones at once.

  /** Frames that have arrived; 0 where nothing moves. */
  get frames() { return this.shared.motion?.source.list.length ?? 0; }
  /** Place of the frame that shows or is being jumped to, from 0. */
  get frame() { return this.shared.motion?.player.frame ?? 0; }
  /** Seconds of the frames that have arrived; 0 where nothing moves. */
  get duration() { return this.shared.motion?.player.duration ?? 0; }
  /** Seconds from the first frame to `frame`. */
  get time() { return this.shared.motion?.player.time ?? 0; }
  get paused() { return !this.shared.motion?.player.playing; }
  get loop() { return this.shared.motion?.player.loop ?? true; }
  set loop(on) { this.shared.motion?.player.setLoop(Boolean(on)); }
  /** 1: as the file has it; 1/16 to 16. */
  get speed() { return this.shared.motion?.player.speed ?? 1; }
  set speed(speed) { this.shared.motion?.player.setSpeed(speed); }

  /** From where it stands; from the first frame, where it has ended. update() moves it. */
  play() { this.shared.motion?.play(); }
  pause() { this.shared.motion?.player.pause(); }

  /**
   * Moves what plays on, before a scene is rendered; once for all clones.
   * @param {number} seconds  since the last call
   * @returns {boolean} whether it plays  @throws {RangeError} of no such number
   */
  update(seconds) {
    return this.shared.motion?.update(seconds) ?? false;
  }

  /**
   * To the frame of a time: where it repeats, of a time in any lap, else from the first to the last.
   * @returns {Promise<number>} the place of the frame that was asked for last, when it shows
   *   It is rejected with a ViewerError where a decode fails, with an AbortError after dispose()
   * @throws {RangeError} of no such number
   */
  setTime(seconds) {
    return this.shared.motion?.setTime(seconds) ?? Promise.resolve(0);
  }

  /** To a frame that has arrived, by its place from 0; else as setTime(). */
  setFrame(place) {
    return this.shared.motion?.setFrame(place) ?? Promise.resolve(0);
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

  /** With the frame that shows in its textures: one that is never drawn is never uploaded. */
  pipelineOf(gl) {
    this.join();
    const { pipelines, packed } = this.shared;
    let own = pipelines.get(gl);
    if (!own || own.lost) {
      own = { pipeline: null, packed: null, failure: null, lost: false, listening: new AbortController() };
      pipelines.set(gl, own);
      gl.canvas.addEventListener('webglcontextlost', markLost(own), { once: true, signal: own.listening.signal });
    }
    if (own.packed !== packed) withState(gl, () => fill(gl, own, packed));
    if (own.failure) throw own.failure;
    return own.pipeline;
  }

  /** Among those that share, again after dispose(). */
  join() {
    if (!this.disposed) return;
    this.disposed = false;
    ++this.shared.users;
    this.shared.motion?.objects.add(this);
  }

  /**
   * Textures go with the last of the clones, and what decodes frames. It can be drawn again, and stands still then at the
   * frame that showed last.
   */
  dispose() {
    const { shared } = this;
    this.material.dispose();
    shared.motion?.objects.delete(this);
    if (!this.disposed) --shared.users;
    this.disposed = true;
    if (shared.users > 0) return;
    shared.geometry.dispose();
    shared.motion?.dispose();
    for (const own of shared.pipelines.values()) {
      if (!own.lost) own.pipeline?.dispose();
      own.listening.abort();
      own.pipeline = own.packed = null;
    }
    shared.pipelines.clear();
  }
}

/** What a light field and its clones have in common. */
function sharedOf(packed, info) {
  return { packed, info, geometry: geometryOf(packed), pipelines: new Map(), users: 0, motion: null };
}

/** Another frame in place of the one that shows: its bounds and rays at once, its textures when it is drawn. */
function showFrame(shared, { packed, info }) {
  Object.assign(shared, { packed, info });
  setBounds(shared.geometry, packed);
}

/** What three asks for bounds: a box of all discs, whose corners are all that it has. None of it is drawn. */
function geometryOf(packed) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(3 * 8), 3));
  geometry.setDrawRange(0, 3);
  geometry.boundingBox = new Box3();
  geometry.boundingSphere = new Sphere();
  geometry.computeBoundingBox = geometry.computeBoundingSphere = () => {};
  setBounds(geometry, packed);
  return geometry;
}

function setBounds(geometry, { box: [low, high], centre, reach, step }) {
  const { position } = geometry.attributes;
  for (let i = 0; i < 8; ++i) position.setXYZ(i, ...[0, 1, 2].map((k) => ((i >> k) & 1 ? high : low)[k]));
  position.needsUpdate = true;
  geometry.boundingBox.set(new Vector3(...low), new Vector3(...high));
  geometry.boundingSphere.set(new Vector3(...centre), reach + 2 * step);
}

/** A pipeline with a field, or why there is none: the next picture of the same field need not try again. */
function fill(gl, own, packed) {
  Object.assign(own, { packed, failure: null });
  try {
    own.pipeline = pipelineWith(gl, packed, own.pipeline);
  } catch (failure) {
    own.failure = failure;
  }
}

const markLost = (own) => () => {
  own.lost = true;
};

/** Depth in the frame buffer is x + y / z, z in voxels; `voxel` in the camera's units. */
function depthRange(p, voxel) {
  // clip z over w of a point z before the camera: (-p[10] z + p[14]) / z
  return [0.5 - 0.5 * p[10], (0.5 * p[14]) / voxel];
}
