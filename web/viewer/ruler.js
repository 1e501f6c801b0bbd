// SPDX-License-Identifier: Apache-2.0
// Lengths: a bar of scale in the caption, and the distance of two points of the object. In metres where the viewer knows
// them, else in units of the file's world.
import { placeAt } from './pick.js';
import { pixelOf } from './view.js';

const STILL = 4; // pixels that a click may move
const BAR = 150; // pixels of the bar of scale, at most
const UNITS = [[1e3, 'km'], [1, 'm'], [1e-2, 'cm'], [1e-3, 'mm']]; // metres, the largest first

/** The largest of 1, 2, 5 and their powers of ten that is no more. */
export function roundLength(most) {
  const ten = 10 ** Math.floor(Math.log10(most));
  return ten * ([5, 2].find((step) => step * ten <= most) ?? 1);
}

/** @param metres  of a unit; 0: nobody knows @param language  of the number */
export function lengthText(units, metres, language = 'en') {
  const digits = (value) => new Intl.NumberFormat(language, { maximumSignificantDigits: 3, useGrouping: false }).format(value);
  if (!(metres > 0)) return `${digits(units)} units`;
  const length = units * metres,
    [size, name] = UNITS.find(([least]) => length >= least * 0.9995) ?? UNITS.at(-1);
  return `${digits(length / size)} ${name}`;
}

export class Ruler {
  /** @param {import('./viewer.js').Viewer} viewer */
  constructor(viewer) {
    this.viewer = viewer;
    this.page = viewer.page;
    this.on = false;
    this.ends = []; // up to two places of the world
    const stage = this.page.at('stage');
    stage.addEventListener('pointerdown', ({ clientX, clientY }) => (this.pressed = [clientX, clientY]));
    stage.addEventListener('click', (event) => this.clicked(event));
    stage.addEventListener('keydown', (event) => {
      const { left, top, width, height } = stage.getBoundingClientRect();
      if (event.key === 'Enter' && this.on) this.take(left + width / 2, top + height / 2);
    });
  }

  text(units) {
    return this.page.t(lengthText(units, this.viewer.metres, this.page.words.language));
  }

  toggle(on = !this.on) {
    this.on = on;
    this.ends = [];
    this.page.press('measure', on);
    for (const way of on ? ['hint', 'say'] : []) this.viewer.report[way]('Click on two points; Enter takes the middle.');
    this.page.at('ruler').hidden = true;
    this.viewer.stage?.redraw();
  }

  clicked({ clientX, clientY }) {
    const turned = this.pressed && Math.hypot(clientX - this.pressed[0], clientY - this.pressed[1]) > STILL;
    if (this.on && !turned) this.take(clientX, clientY);
  }

  /** The place of the object under a point of the window; null beside it. */
  under(x, y) {
    const { stage, controls } = this.viewer;
    if (!stage?.field || !controls.pose) return null;
    const box = stage.canvas.getBoundingClientRect();
    return placeAt(stage, x - box.left, y - box.top);
  }

  /** That place is the next end. */
  take(x, y) {
    const place = this.under(x, y);
    if (!place) return this.viewer.report.hint('There is nothing here.');
    this.ends = this.ends.length === 2 ? [place] : [...this.ends, place];
    this.page.at('length').hidden = this.ends.length < 2;
    if (this.ends.length === 2) this.measured();
    this.viewer.stage.redraw();
  }

  measured() {
    const [from, to] = this.ends,
      { metres } = this.viewer,
      units = Math.hypot(...from.map((x, k) => to[k] - x));
    this.page.at('length').textContent = this.text(units);
    this.viewer.emit('measure', { from, to, units, metres: metres > 0 ? units * metres : null });
  }

  /** After a frame: the ends where their points are, and the bar of scale. */
  lay() {
    this.layBar();
    const { stage } = this.viewer,
      shown = this.on && this.ends.length > 0 && stage.field && (stage.pose || stage.camera);
    const { clientWidth: width, clientHeight: height } = stage.canvas,
      at = shown ? this.ends.map((end) => pixelOf(stage.view(width, height), end)) : [];
    const ruler = this.page.at('ruler');
    ruler.hidden = !shown || at.includes(null);
    if (ruler.hidden) return;
    const [x1, y1] = at[0],
      [x2, y2] = at.at(-1);
    const end = (x, y) => `<circle r="4" cx="${x}" cy="${y}"/>`; // numbers alone
    ruler.firstElementChild.innerHTML = `<path d="M${x1} ${y1}L${x2} ${y2}"/>${end(x1, y1)}${end(x2, y2)}`;
    Object.assign(this.page.at('length').style, { left: `${(x1 + x2) / 2}px`, top: `${(y1 + y2) / 2}px` });
  }

  /** A length at the depth of what the view turns around. */
  layBar() {
    const { stage, metres, options } = this.viewer,
      { pose } = stage,
      bar = this.page.at('scale');
    bar.hidden = !(options.scale && metres > 0 && pose && stage.field);
    if (bar.hidden) return;
    const side = Math.min(stage.canvas.clientWidth, stage.canvas.clientHeight);
    const pixel = (2 * pose.distance * Math.tan((pose.fov * Math.PI) / 360)) / side,
      units = roundLength(BAR * pixel * metres) / metres;
    bar.firstElementChild.style.width = `${Math.max(1, units / pixel)}px`;
    const text = this.text(units);
    if (bar.lastElementChild.textContent !== text) bar.lastElementChild.textContent = text;
  }
}
