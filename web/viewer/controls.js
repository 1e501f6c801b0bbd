// SPDX-License-Identifier: Apache-2.0
// Mouse, touch and keyboard to a pose (view.js). Everything is scaled by the distance, so small and
// large objects turn alike. Nothing here draws.
import { Manners } from './manners.js';
import { add, axesOf } from './view.js';

const TURN = 0.35; // degrees a pixel
const STEP = 6; // degrees an arrow key
const FRICTION = 0.9; // of the speed that is left after 1/60 s
const KEYS = { KeyW: [2, 1], KeyS: [2, -1], KeyD: [0, 1], KeyA: [0, -1], KeyE: [1, -1], KeyQ: [1, 1] };

export class Controls {
  /**
   * @param {HTMLElement} element  that is dragged on; focusable, for keys
   * @param {object} on  change(): the pose has moved; start(): a person has begun to; refused(text): a polite viewer
   *   leaves a gesture to the page, and what would have moved it
   */
  constructor(element, on) {
    this.element = element;
    this.on = on;
    this.pose = null;
    this.up = '+z';
    this.mode = 'orbit'; // or 'fly'
    this.radius = 1; // of the light field, world
    this.smooth = !matchMedia('(prefers-reduced-motion: reduce)').matches;
    this.speed = [0, 0]; // degrees a frame, of what was let go
    this.pressed = new Set();
    this.pointers = new Map();
    this.manners = new Manners(element, (text) => on.refused?.(text));
    const listen = (type, handler, options) => element.addEventListener(type, handler.bind(this), options);
    listen('pointerdown', this.pointerDown);
    listen('pointermove', this.pointerMove);
    for (const type of ['pointerup', 'pointercancel', 'lostpointercapture']) listen(type, this.pointerUp);
    listen('wheel', this.wheel, { passive: false });
    listen('contextmenu', (event) => event.preventDefault());
    listen('keydown', this.keyDown);
    listen('keyup', (event) => this.pressed.delete(event.code));
    listen('blur', () => this.pressed.clear());
  }

  /** Whether the page scrolls until somebody takes hold. */
  setPolite(polite) {
    this.manners.set(polite);
  }

  dispose() {
    this.manners.dispose();
  }

  /** The object keeps its size. */
  setFov(fov) {
    const { pose } = this;
    if (!pose) return;
    const width = (degrees) => Math.tan((degrees * Math.PI) / 360);
    pose.distance *= width(pose.fov) / width(fov);
    pose.fov = fov;
    this.on.change();
  }

  /** Moves what is in motion. @returns {boolean} whether anything still is */
  tick(seconds) {
    if (!this.pose) return false;
    const frames = Math.min(seconds, 0.1) * 60;
    let moving = false;
    if (this.pointers.size === 0 && Math.hypot(...this.speed) > 0.02) {
      this.turn(this.speed[0] * frames, this.speed[1] * frames);
      this.speed = this.speed.map((v) => v * FRICTION ** frames);
      moving = true;
    }
    for (const code of this.pressed) {
      const [axis, sign] = KEYS[code];
      this.move(axis, sign * 0.012 * frames * this.radius);
      moving = true;
    }
    return moving;
  }

  turn(azimuth, elevation) {
    const { pose } = this,
      before = this.mode === 'fly' ? this.eye() : null;
    pose.azimuth = ((pose.azimuth + azimuth + 540) % 360) - 180;
    pose.elevation = Math.max(-90, Math.min(90, pose.elevation + elevation));
    if (before) pose.target = add(before, axesOf(pose, this.up)[2], pose.distance);
    this.on.change();
  }

  /** Towards the target by a factor; in flight, forwards. */
  zoom(factor) {
    if (this.mode === 'fly') return this.move(2, this.radius * Math.log(factor) * -0.5);
    this.pose.distance = Math.max(1e-3 * this.radius, Math.min(100 * this.radius, this.pose.distance * factor));
    this.on.change();
  }

  /** Eye and target, along right (0), down (1) or forward (2). */
  move(axis, length) {
    this.pose.target = add(this.pose.target, axesOf(this.pose, this.up)[axis], length);
    this.on.change();
  }

  /** Target by pixels, so that what is under the pointer stays there. */
  pan(dx, dy) {
    const { pose } = this,
      box = this.element.getBoundingClientRect();
    const pixel = (2 * pose.distance * Math.tan((pose.fov * Math.PI) / 360)) / Math.min(box.width, box.height);
    this.move(0, -dx * pixel);
    this.move(1, -dy * pixel);
  }

  eye() {
    return add(this.pose.target, axesOf(this.pose, this.up)[2], -this.pose.distance);
  }

  pointerDown(event) {
    if (!this.pose || !this.manners.admits(event)) return;
    this.element.setPointerCapture(event.pointerId);
    for (const [id, place] of this.manners.waiting) this.pointers.set(id, place); // the first of two fingers
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    this.speed = [0, 0];
    this.panning = event.button === 2 || event.button === 1 || event.shiftKey;
    this.element.classList.add('grabbing');
    this.on.start();
  }

  pointerMove(event) {
    const last = this.pointers.get(event.pointerId);
    if (!last) return;
    const before = this.spread();
    const dx = event.clientX - last[0],
      dy = event.clientY - last[1];
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    if (this.pointers.size >= 2) {
      const after = this.spread();
      if (before.length > 0 && after.length > 0) this.zoom(before.length / after.length);
      const moved = [after.middle[0] - before.middle[0], after.middle[1] - before.middle[1]];
      return this.manners.scrolls ? this.turn(...this.turned(...moved)) : this.pan(...moved);
    }
    if (this.panning) return this.pan(dx, dy);
    const turned = this.turned(dx, dy);
    this.turn(...turned);
    if (this.smooth) this.speed = turned.map((v, i) => 0.6 * v + 0.4 * this.speed[i]);
    this.moved = event.timeStamp;
  }

  /** Degrees of so many pixels. */
  turned(dx, dy) {
    const sign = this.mode === 'fly' ? 0.4 : -1;
    return [sign * TURN * dx, -sign * TURN * dy];
  }

  pointerUp(event) {
    if (!this.pointers.delete(event.pointerId)) return;
    if (event.timeStamp - (this.moved ?? 0) > 60) this.speed = [0, 0]; // held still before it was let go
    if (this.pointers.size === 0) this.element.classList.remove('grabbing');
    if (Math.hypot(...this.speed) > 0) this.on.change();
  }

  /** Of the first two pointers. */
  spread() {
    const [a, b = a] = [...this.pointers.values()];
    return { length: Math.hypot(a[0] - b[0], a[1] - b[1]), middle: [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2] };
  }

  wheel(event) {
    if (!this.pose || !this.manners.admits(event)) return;
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 16 : 1;
    this.on.start();
    this.zoom(Math.exp(Math.max(-60, Math.min(60, event.deltaY * lines)) * (event.ctrlKey ? 0.008 : 0.002)));
  }

  keyDown(event) {
    if (!this.pose || event.ctrlKey || event.metaKey || event.altKey) return;
    if (this.mode === 'fly' && Object.hasOwn(KEYS, event.code)) {
      this.pressed.add(event.code);
      event.preventDefault();
      this.on.start();
      return this.on.change();
    }
    const action = this.keyAction(event);
    if (!action) return;
    event.preventDefault();
    this.on.start();
    action();
  }

  keyAction({ key, shiftKey }) {
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    if (Object.hasOwn(arrows, key)) {
      const [x, y] = arrows[key];
      return shiftKey ? () => this.pan(-24 * x, 24 * y) : () => this.turn(STEP * x, STEP * y);
    }
    if (key === '+' || key === '=' || key === 'PageUp') return () => this.zoom(0.9);
    if (key === '-' || key === 'PageDown') return () => this.zoom(1 / 0.9);
    return null;
  }
}
