// Which of many viewers on a page are awake: those that are near what is seen, and no more than browsers have
// graphics contexts for.

const MOST = 8; // contexts; browsers end the oldest of 16
const NEAR = '50%'; // of the window, from its edge

export class Turns {
  #seen = new Map(); // viewer: whether it is near
  #awake = []; // the one that was seen longest ago first
  #observer = null;

  /** Wakes it when it is near, at once with loading="eager" or `now`, and on a click with loading="click". */
  watch(viewer, now = false) {
    this.#observer ??= new IntersectionObserver((entries) => this.#moved(entries), { rootMargin: NEAR });
    this.#seen.set(viewer, false);
    this.#observer.unobserve(viewer);
    const loading = viewer.getAttribute('loading');
    if (loading === 'click' && !now) return viewer.addEventListener('click', () => this.#wake(viewer), { once: true });
    if (now || loading === 'eager') this.#wake(viewer);
    this.#observer.observe(viewer);
  }

  forget(viewer) {
    this.#observer?.unobserve(viewer);
    this.#seen.delete(viewer);
    this.#awake = this.#awake.filter((each) => each !== viewer);
  }

  #moved(entries) {
    for (const { target, isIntersecting } of entries) {
      if (!this.#seen.has(target)) continue;
      this.#seen.set(target, isIntersecting);
      if (isIntersecting) this.#wake(target);
    }
  }

  #wake(viewer) {
    this.#awake = [...this.#awake.filter((each) => each !== viewer), viewer];
    while (this.#awake.length > MOST) {
      const away = this.#awake.findIndex((each) => each !== viewer && !this.#seen.get(each));
      this.#awake.splice(Math.max(0, away), 1)[0].sleep();
    }
    viewer.wake();
  }
}
