// SPDX-License-Identifier: Apache-2.0
// A canvas with one light field on it: draws when something has changed, coarser while frames are
// slow and a hand moves, and again after the context was lost.
import { pipelineWith } from './pipelines.js';
import { summary } from './point_pipeline.js';
import { SurfelPipeline } from './surfel_pipeline.js';
import { COLUMNS, ViewerError } from './packed_field.js';
import { fittedCamera, viewOf } from './view.js';

const SLOW = 40,
  FAST = 18; // ms a frame, beyond which resolution changes while moving
const COARSEST = 0.4; // of the screen's resolution
const REST = 180; // ms after which a picture at rest is drawn in full

export class Stage {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {object} on  tick(seconds): before a frame, true to be called again; drawn(); lost(); restored(error)
   * @throws {ViewerError} kind 'no-webgl2'
   */
  constructor(canvas, on = {}) {
    this.canvas = canvas;
    this.on = on;
    this.gl = canvas.getContext('webgl2', { alpha: true, antialias: false, depth: false, premultipliedAlpha: true });
    if (!this.gl) throw new ViewerError('no-webgl2', 'This browser offers no WebGL 2.');
    this.pipeline = new SurfelPipeline(this.gl);
    this.packed = this.field = null; // what is shown, kept for a context that was lost, and its summary
    this.pose = this.camera = null; // one or the other: a pose of an orbit, a capture's camera
    this.look = { background: null, exposure: 0, meanOnly: false, share: 1, resolution: 1 };
    this.scale = 1;
    this.frameTime = 0;
    this.settled = true;
    this.asked = 0;
    this.lent = false; // somebody else draws with its context
    canvas.addEventListener('webglcontextlost', (event) => this.lose(event));
    canvas.addEventListener('webglcontextrestored', () => this.restore());
    this.observer = new ResizeObserver(() => this.redraw());
    this.observer.observe(canvas);
  }

  /** That the textures of this device hold. */
  get mostPoints() {
    return COLUMNS * (this.gl.getParameter(this.gl.MAX_TEXTURE_SIZE) ?? Infinity); // null: the context is lost
  }

  /** While the context is lost it is uploaded when that comes back. */
  setField(packed) {
    if (!this.gl.isContextLost()) this.pipeline = pipelineWith(this.gl, packed, this.pipeline);
    this.packed = packed;
    this.field = summary(packed);
    this.redraw();
  }

  clear() {
    this.pipeline.clearField();
    this.packed = this.field = null;
    this.pose = this.camera = null;
    this.redraw();
  }

  /** A frame soon. @param {boolean} moving  more will follow: it may be coarse */
  redraw({ moving = false } = {}) {
    this.settled = this.settled && !moving;
    if (this.asked || this.lent || this.gl.isContextLost()) return;
    this.asked = requestAnimationFrame((now) => this.frame(now));
  }

  frame(now) {
    this.asked = 0;
    const since = now - (this.last ?? now);
    this.last = now;
    const more = this.on.tick?.(since / 1000) ?? false;
    if (more) this.settled = false;
    if (!this.settled) this.adapt(since);
    clearTimeout(this.rest);
    const scale = this.settled ? 1 : this.scale;
    this.draw(scale, !this.settled);
    if (more || this.pipeline.unsettled) return this.redraw({ moving: true });
    this.last = undefined;
    if (this.settled) return;
    this.rest = setTimeout(() => {
      this.settled = true;
      if (scale < 1) this.redraw();
    }, REST);
  }

  /** The time between frames of a motion decides how fine the next is. */
  adapt(since, slow = SLOW, fast = FAST) {
    if (!(since > 0 && since < 2000)) return;
    this.frameTime = this.frameTime ? 0.7 * this.frameTime + 0.3 * since : since;
    if (this.frameTime > slow) this.scale = Math.max(COARSEST, this.scale * 0.85);
    else if (this.frameTime < fast) this.scale = Math.min(1, this.scale * 1.1);
  }

  /** A session of WebXR has the context until takeBack(), and draws by drawInto(). */
  lend() {
    this.lent = true;
    cancelAnimationFrame(this.asked);
    clearTimeout(this.rest);
    this.asked = 0;
  }

  takeBack() {
    this.lent = false;
    this.last = undefined;
    this.redraw();
  }

  /** Over a part of a framebuffer. @param camera  (width, height) => View @param options  beside the look: of accumulate() */
  drawInto(framebuffer, viewport, camera, options) {
    const { gl, pipeline } = this,
      size = viewport.slice(2).map((v) => Math.max(1, Math.round(v * this.scale)));
    pipeline.accumulate(camera(...size), { ...this.look, ...options });
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    pipeline.resolve({ viewport, exposure: this.look.exposure });
  }

  /** @returns {[number, number]} pixels of the screen that the canvas has */
  pixels() {
    const density = Math.min(devicePixelRatio || 1, 3) * this.look.resolution;
    return [this.canvas.clientWidth, this.canvas.clientHeight].map((v) => Math.max(1, Math.round(v * density)));
  }

  /** @param {boolean} patient  more frames will follow, of what takes longer than this */
  draw(scale = 1, patient = false) {
    const { gl, canvas, pipeline } = this,
      [width, height] = this.pixels();
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    const size = [width, height].map((v) => Math.max(1, Math.round(v * scale)));
    if (pipeline.field && (this.pose || this.camera)) pipeline.accumulate(this.view(...size), { ...this.look, patient });
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    this.paint([0, 0, width, height], this.look.background);
    this.on.drawn?.();
  }

  view(width, height) {
    return this.camera ? fittedCamera(this.camera, width, height) : viewOf(this.pose, this.field.up, width, height);
  }

  /** @param {number[]|null} background  RGB 0 .. 1; null: transparent */
  paint(viewport, background) {
    const { gl } = this;
    gl.clearColor(...(background ?? [0, 0, 0]), background ? 1 : 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    this.pipeline.resolve({ viewport, exposure: this.look.exposure });
  }

  /** RGBA of a camera's own picture, without background: alpha is coverage; rows from the bottom. */
  readCamera(camera) {
    const { gl, pipeline } = this,
      { width, height } = camera;
    const texture = gl.createTexture(),
      buffer = gl.createFramebuffer(),
      out = new Uint8Array(4 * width * height);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA8, width, height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, buffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    pipeline.accumulate(fittedCamera(camera, width, height), { ...this.look, share: 1 });
    gl.bindFramebuffer(gl.FRAMEBUFFER, buffer);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    pipeline.resolve({ viewport: [0, 0, width, height] });
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, out);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.deleteFramebuffer(buffer);
    gl.deleteTexture(texture);
    this.redraw();
    return out;
  }

  /** @returns {Promise<Blob>} PNG of what is shown, in full resolution */
  screenshot() {
    this.draw();
    return new Promise((resolve) => this.canvas.toBlob(resolve, 'image/png'));
  }

  lose(event) {
    event.preventDefault();
    cancelAnimationFrame(this.asked);
    this.asked = 0;
    this.on.lost?.();
  }

  restore() {
    try {
      this.pipeline = new SurfelPipeline(this.gl);
      if (this.packed) this.setField(this.packed);
      this.on.restored?.();
    } catch (error) {
      this.on.restored?.(error);
    }
  }

  dispose() {
    this.observer.disconnect();
    cancelAnimationFrame(this.asked);
    clearTimeout(this.rest);
    this.pipeline.dispose();
    this.gl.getExtension('WEBGL_lose_context')?.loseContext();
  }
}
