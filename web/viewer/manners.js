// SPDX-License-Identifier: Apache-2.0
// Whose gestures are: a viewer within a page that scrolls leaves one finger and the wheel to the page until somebody
// takes hold of it by a click or a tap, and lets go when the hand goes elsewhere. Two fingers are always the viewer's.

const TAP = { ms: 400, pixels: 10 };

export class Manners {
  /** @param {(text: string) => void} refused  a gesture was left to the page; how it would not be */
  constructor(element, refused) {
    this.element = element;
    this.refused = refused;
    this.polite = this.held = false;
    this.waiting = new Map(); // fingers that the page may want
    this.end = new AbortController();
    const listen = (target, type, handler, options) =>
      target.addEventListener(type, handler.bind(this), { signal: this.end.signal, ...options });
    for (const type of ['touchstart', 'touchmove']) listen(element, type, this.touch, { passive: false });
    for (const type of ['pointerup', 'pointercancel']) listen(element, type, this.lifted);
    listen(element, 'pointerleave', (event) => event.pointerType === 'mouse' && event.buttons === 0 && this.hold(false));
    listen(document, 'pointerdown', (event) => event.composedPath().includes(element) || this.hold(false), { capture: true });
    listen(element, 'keydown', (event) => event.key === 'Escape' && this.hold(false));
    this.observer = new IntersectionObserver(([{ isIntersecting }]) => isIntersecting || this.hold(false));
    this.observer.observe(element);
  }

  /** Whether the page has one finger and the wheel now. */
  get scrolls() {
    return this.polite && !this.held;
  }

  set(polite) {
    this.polite = polite;
    this.hold(false);
  }

  hold(held) {
    this.held = this.polite && held;
    this.waiting.clear();
    this.element.classList.toggle('polite', this.scrolls);
  }

  /** Whether an event of a pointer or a wheel is the viewer's. */
  admits(event) {
    if (!this.scrolls) return true;
    if (event.type === 'wheel') {
      if (event.ctrlKey || event.metaKey) return true;
      this.refused('To zoom, click first or hold Ctrl');
      return false;
    }
    if (event.pointerType !== 'touch') {
      this.hold(true);
      return true;
    }
    if (this.waiting.size > 0) return true; // the second finger
    this.waiting.set(event.pointerId, [event.clientX, event.clientY]);
    this.began = event.timeStamp;
    return false;
  }

  /** Two fingers do not scroll the page. */
  touch(event) {
    if (this.scrolls && event.touches.length >= 2 && event.cancelable) event.preventDefault();
  }

  lifted(event) {
    const place = this.waiting.get(event.pointerId);
    if (!place) return;
    this.waiting.delete(event.pointerId);
    if (event.type === 'pointercancel') return this.refused('To turn it, tap first or use two fingers');
    const moved = Math.hypot(event.clientX - place[0], event.clientY - place[1]);
    if (event.timeStamp - this.began < TAP.ms && moved < TAP.pixels) this.hold(true);
  }

  dispose() {
    this.end.abort();
    this.observer.disconnect();
  }
}
