// SPDX-License-Identifier: Apache-2.0
// Sessions of WebXR that this device has: their buttons, and the way in. What draws in them, xr.js, is fetched there alone.

const MODES = { vr: 'immersive-vr', ar: 'immersive-ar' };

export class Rooms {
  #code = null; // a promise of xr.js
  #room = null; // a promise of the one that is entered

  /** @param {import('./viewer.js').Viewer} viewer */
  constructor(viewer) {
    this.viewer = viewer;
  }

  /** Shows the buttons of what there is. A page may forbid all of it: then there is none. */
  async offer() {
    for (const [action, mode] of Object.entries(MODES)) {
      if (!(await navigator.xr?.isSessionSupported(mode).catch(() => false))) continue;
      this.#code ??= import('./xr.js');
      this.#code.catch(() => (this.#code = null)); // said when it is wanted
      this.viewer.page.one(`[data-do=${action}]`).hidden = false;
    }
  }

  /** In, or out of where one is. To be called by a hand: browsers ask for that. @param {'vr'|'ar'} action */
  async toggle(action) {
    if (this.#room) return this.end();
    const { report } = this.viewer,
      done = () => this.#show(action, (this.#room = null));
    try {
      this.#room = (this.#code ??= import('./xr.js')).then(({ enterRoom }) => enterRoom(this.viewer, MODES[action], done));
      await this.#room;
      this.#show(action, true);
      if (action === 'ar') report.hint('Look at a surface, then tap.');
    } catch {
      this.#room = null;
      report.say('The room cannot be shown.');
      report.hint('The room cannot be shown.');
    }
  }

  async end() {
    const room = await this.#room?.catch(() => null);
    return room?.end();
  }

  #show(action, on) {
    const { page } = this.viewer;
    page.press(action, Boolean(on));
    page.frame.classList.toggle('room', Boolean(on) && action === 'ar'); // over what a phone sees
    this.viewer.emit(on ? 'xrstart' : 'xrend', { mode: MODES[action] });
  }
}
