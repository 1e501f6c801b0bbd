// SPDX-License-Identifier: Apache-2.0
// Which of many viewers on a page are awake: those that are near what is seen, and no more than browsers have
// graphics contexts for.

const MOST = 8; // contexts; browsers end the oldest of 16
const NEAR = '50%'; // of the window, from its edge
const SETTLED = /^(ready|failed)/;
const isSettled = ({ state, viewer }) => SETTLED.test(state) || (viewer !== null && state === 'idle'); // it has no file

export class Turns {
  #seen = new Map(); // viewer: whether it is near
  #awake = []; // the one that woke first stands first
  #queue = []; // near, while all that are awake still load
  #observer = null;

  /** Wakes it when it is near, at once with loading="eager" or `now`, and on a click; with loading="click" only then. */
  watch(viewer, now = false) {
    this.#observer ??= new IntersectionObserver((entries) => this.#moved(entries), { rootMargin: NEAR });
    this.#seen.set(viewer, false);
    this.#observer.unobserve(viewer);
    for (const type of ['ready', 'error']) viewer.addEventListener(type, this.#next);
    viewer.addEventListener('click', this.#clicked);
    viewer.addEventListener('keydown', this.#pressed);
    const loading = viewer.getAttribute('loading');
    if (now || loading === 'eager') this.#wake(viewer);
    if (now || loading !== 'click') this.#observer.observe(viewer);
  }

  forget(viewer) {
    for (const type of ['ready', 'error']) viewer.removeEventListener(type, this.#next);
    viewer.removeEventListener('click', this.#clicked);
    viewer.removeEventListener('keydown', this.#pressed);
    this.#observer?.unobserve(viewer);
    this.#seen.delete(viewer);
    this.#awake = this.#awake.filter((each) => each !== viewer);
    this.#queue = this.#queue.filter((each) => each !== viewer);
  }

  #clicked = ({ currentTarget }) => this.#wake(currentTarget);
  #pressed = (event) => {
    if (!['Enter', ' '].includes(event.key) || this.#awake.includes(event.currentTarget)) return;
    event.preventDefault();
    this.#wake(event.currentTarget);
  };
  #next = () => this.#queue.length > 0 && this.#wake(this.#queue.shift());

  #moved(entries) {
    for (const { target, isIntersecting } of entries) {
      if (!this.#seen.has(target)) continue;
      this.#seen.set(target, isIntersecting);
      if (isIntersecting) this.#wake(target);
      else this.#queue = this.#queue.filter((each) => each !== target);
    }
  }

  #wake(viewer) {
    if (this.#awake.includes(viewer)) return;
    if (this.#awake.length >= MOST) {
      const away = this.#awake.findIndex((each) => !this.#seen.get(each));
      const rests = away >= 0 ? away : this.#awake.findIndex((each) => isSettled(each)); // its picture stays
      if (rests < 0) return void (this.#queue.includes(viewer) || this.#queue.push(viewer));
      this.#awake.splice(rests, 1)[0].sleep();
    }
    this.#awake.push(viewer);
    viewer.wake();
  }
}
