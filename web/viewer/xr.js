// SPDX-License-Identifier: Apache-2.0
// A light field in a room, by WebXR: before a headset, or on a surface that a phone sees. rooms.js fetches this file
// where a device has such sessions.
import { add, axesOf, dot, upAxes, viewOfCamera } from './view.js';
import { backgroundColour } from './options.js';

const ACROSS = 0.5, // metres, of what does not say how large it is
  TRUE_SIZES = [0.02, 4]; // metres across that are shown as they are
const BEFORE = 0.7; // metres from the eye to the near side of what nobody has placed
const DRAG = 90, // degrees of half a screen
  TAP = 0.02; // of half a screen: a finger that moves farther turns, and places nothing
const STICK = { turn: 90, grow: 2, rest: 0.15 }; // degrees and factor a second; tilt that counts as none
const LEVEL = 0.7; // height of the normal of a surface that things can stand on
const SLOW = 22,
  FAST = 15; // ms a frame, beyond which the resolution changes

/** @param mode  immersive-vr or immersive-ar @param ended  is called once @throws what the browser says; nothing has changed then */
export async function enterRoom(viewer, mode, ended) {
  const { gl } = viewer.stage;
  const session = await navigator.xr.requestSession(mode, {
    optionalFeatures: ['hit-test', 'dom-overlay'],
    domOverlay: { root: viewer.page.frame },
  });
  try {
    await gl.makeXRCompatible();
    session.updateRenderState({ baseLayer: new XRWebGLLayer(session, gl, { antialias: false, depth: false }) });
    const [space, eyes] = await Promise.all(['local', 'viewer'].map((type) => session.requestReferenceSpace(type)));
    const hits = mode === 'immersive-ar' ? await session.requestHitTestSource?.({ space: eyes }).catch(() => null) : null;
    return new Room(viewer, session, { space, hits, seeThrough: mode === 'immersive-ar' }, ended);
  } catch (error) {
    session.end().catch(() => {});
    throw error;
  }
}

class Room {
  constructor(viewer, session, { space, hits, seeThrough }, ended) {
    Object.assign(this, { viewer, session, space, hits, seeThrough });
    this.at = null; // [3] metres, where the anchor is; null: before the eyes, when these are known
    this.anchor = null; // [3] of the light field
    this.yaw = 0; // degrees from the room's z axis to the side that is looked at
    this.follows = Boolean(hits); // it is where a surface is looked at
    this.grown = 1;
    this.touches = [];
    viewer.stage.lend();
    session.addEventListener('selectstart', () => Object.assign(this, { dragged: false, touched: null }));
    session.addEventListener('select', () => this.dragged || this.place());
    session.addEventListener('end', () => {
      viewer.stage.takeBack();
      ended();
    });
    session.requestAnimationFrame((now, frame) => this.frame(now, frame));
  }

  end() {
    return this.session.end();
  }

  /** A tap or a trigger: it stays, it follows again; where no surface is known it comes before the eyes. */
  place() {
    if (this.hits) this.follows = !this.follows;
    else this.at = null;
  }

  frame(now, frame) {
    const { viewer, session, space } = this,
      { stage } = viewer,
      since = now - (this.last ?? now);
    this.last = now;
    session.requestAnimationFrame((...next) => this.frame(...next));
    if (stage.gl.isContextLost()) return void this.end();
    viewer.tick(since / 1000);
    const pose = frame.getViewerPose(space);
    if (!pose || !stage.field || !viewer.controls.pose) return;
    stage.adapt(since, SLOW, FAST);
    this.gestures(since / 1000);
    this.stand(frame, pose.transform);
    const { baseLayer } = session.renderState;
    this.paint(baseLayer.framebuffer);
    pose.views.forEach((view, i) => {
      const { x, y, width, height } = baseLayer.getViewport(view);
      if (!(width > 0 && height > 0)) return; // of an eye that is not there
      const camera = (w, h) => viewOfCamera(view.projectionMatrix, this.toField(view.transform.matrix), w, h).view;
      stage.drawInto(baseLayer.framebuffer, [x, y, width, height], camera, { sameOrder: i > 0 });
    });
  }

  /** Nothing through which the room shows, or the background; by itself a dark one. */
  paint(framebuffer) {
    const { gl, look } = this.viewer.stage;
    const colour = this.seeThrough ? null : this.viewer.chosen === null ? backgroundColour('slate') : look.background;
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.clearColor(...(colour ?? [0, 0, 0]), colour ? 1 : 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
  }

  // Where it stands

  /** Metres of a unit of the light field. */
  get scale() {
    const { metres } = this.viewer,
      units = 2 * this.viewer.stage.field.radius,
      [least, most] = TRUE_SIZES,
      across = metres * units;
    return this.grown * (across >= least && across <= most ? metres : ACROSS / units);
  }

  stand(frame, eyes) {
    const { x, y, z } = eyes.position,
      m = eyes.matrix;
    const hit = this.follows && frame.getHitTestResults(this.hits)[0]?.getPose(this.space)?.transform;
    if (hit && hit.matrix[5] > LEVEL) {
      const { position } = hit;
      this.at = [position.x, position.y, position.z];
      this.anchor = this.foot();
      this.yaw = degrees(x - position.x, z - position.z);
    }
    if (this.at) return;
    const { centre, radius } = this.viewer.stage.field;
    this.anchor = centre;
    this.yaw = degrees(m[8], m[10]); // the eyes look along -z
    const far = BEFORE + radius * this.scale,
      angle = (this.yaw * Math.PI) / 180;
    this.at = [x - far * Math.sin(angle), y, z - far * Math.cos(angle)];
  }

  /** The middle of its lowest side. */
  foot() {
    const { field, packed } = this.viewer.stage,
      up = upAxes(field.up)[2],
      low = Math.min(...packed.box.map((corner) => dot(corner, up)));
    return add(field.centre, up, low - dot(field.centre, up));
  }

  /** A matrix to the room, of columns, as one to the light field. */
  toField(matrix) {
    const { controls, stage } = this.viewer,
      [right, down, forward] = axesOf({ azimuth: controls.pose.azimuth - this.yaw, elevation: 0 }, stage.field.up);
    const column = (i, from) => {
      const [x, y, z] = from.map((v, k) => (matrix[4 * i + k] - v) / this.scale);
      return right.map((v, k) => v * x - down[k] * y - forward[k] * z);
    };
    const axes = [0, 1, 2].flatMap((i) => [...column(i, [0, 0, 0]), 0]);
    return [...axes, ...add(this.anchor, column(3, this.at)), 1];
  }

  // Hands

  /** A finger turns it, two change its size; so do the sticks of controllers. */
  gestures(seconds) {
    const before = this.touches;
    this.touches = [];
    for (const { targetRayMode, gamepad } of this.session.inputSources) {
      if (!gamepad) continue;
      if (targetRayMode === 'screen') this.touches.push([...gamepad.axes]);
      else this.tilt(gamepad.axes, seconds);
    }
    if (this.touches.length === 0 || this.touches.length !== before.length) return;
    const [[x]] = this.touches,
      [[a]] = before;
    this.touched ??= a;
    this.dragged ||= this.touches.length > 1 || Math.abs(x - this.touched) > TAP;
    if (this.touches.length > 1) this.grow(spread(this.touches) / spread(before));
    else if (this.dragged) this.turn(DRAG * (x - a));
  }

  tilt([, , x = 0, y = 0], seconds) {
    if (Math.abs(x) > STICK.rest) this.turn(STICK.turn * x * seconds);
    if (Math.abs(y) > STICK.rest) this.grow(STICK.grow ** (-y * seconds));
  }

  turn(angle) {
    this.viewer.controls.pose.azimuth -= angle;
  }

  grow(factor) {
    if (factor > 0 && factor < Infinity) this.grown = Math.min(100, Math.max(0.01, this.grown * factor));
  }
}

const degrees = (x, z) => (Math.atan2(x, z) * 180) / Math.PI;
const spread = ([[ax, ay], [bx, by]]) => Math.hypot(ax - bx, ay - by);
