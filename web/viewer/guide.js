// SPDX-License-Identifier: Apache-2.0
// Notes on the stage: a mark for each annotation where its point is, a card with its text, and tracks that are played.
import { fetchNotes, parseNotes, readNotes } from './notes.js';
import { pick } from './pick.js';
import { blendedPose, fittingPose, pixelOf } from './view.js';

const BUDGET = 3e6, // points that are asked in a frame whether they hide a mark
  SLACK = 3; // voxels before a mark that do not hide it

export class Guide {
  /** @param {import('./viewer.js').Viewer} viewer */
  constructor(viewer) {
    this.viewer = viewer;
    this.page = viewer.page;
    this.close();
  }

  /** @param {string|object} source  address, or notes as JSON gives them. A fault in notes is said; the object shows. */
  open(source) {
    return this.take(() => (typeof source === 'string' ? fetchNotes(source) : readNotes(source)));
  }

  /** @param {Record<string, string>} metadata  of a file: its own notes, if it has some */
  async openOwn(metadata = {}) {
    if (Object.hasOwn(metadata, 'notes')) await this.take(() => parseNotes(metadata.notes));
  }

  /** @param {() => object|Promise<object>} read  what readNotes() gives, or a fault */
  async take(read) {
    this.close();
    const { source: file } = this.viewer;
    try {
      const notes = await read();
      if (file !== this.viewer.source) return; // another was opened
      this.notes = notes;
    } catch (error) {
      if (file !== this.viewer.source) return;
      console.warn(error.message);
      this.viewer.report.say(error.words ?? error.message);
      this.viewer.report.hint(error.words ?? error.message);
      this.viewer.emit('noteserror', error);
      return;
    }
    this.marks = this.notes.annotations.map((each, i) => this.mark(each, i));
    this.page.at('marks').replaceChildren(...this.marks);
    this.page.one('[data-do=tour]').hidden = this.notes.tracks.length === 0;
    this.viewer.stage.redraw();
  }

  close() {
    this.notes = { annotations: [], tracks: [] };
    this.marks = [];
    this.shown = undefined;
    this.asked = 0; // the mark that is asked next whether it is hidden
    this.stop();
    this.page.at('marks').replaceChildren();
    this.page.at('note').hidden = true;
    this.page.one('[data-do=tour]').hidden = true;
  }

  mark({ title }, i) {
    const mark = document.createElement('button');
    mark.type = 'button';
    mark.className = 'mark-of-note';
    mark.textContent = String(i + 1);
    mark.setAttribute('aria-label', `${i + 1}: ${title}`);
    mark.title = title;
    mark.addEventListener('click', () => {
      this.stop();
      this.show(i);
    });
    return mark;
  }

  /** Opens the card of an annotation, and turns to its view where it has one. */
  show(i, turning = true) {
    const { title, text, view } = this.notes.annotations[i];
    this.shown = i;
    const card = this.page.at('note');
    card.querySelector('h2').textContent = title;
    card.querySelector('p').textContent = text;
    card.hidden = false;
    this.marks.forEach((mark, k) => mark.setAttribute('aria-pressed', String(k === i)));
    if (turning && view) this.travel([{ view, seconds: 1, pause: 0, annotation: null }]);
    this.viewer.emit('annotation', { index: i, title });
  }

  next() {
    if (this.marks.length) this.show(((this.shown ?? -1) + 1) % this.marks.length);
  }

  hide() {
    this.page.at('note').hidden = true;
    this.marks[this.shown]?.focus();
    this.marks.forEach((mark) => mark.setAttribute('aria-pressed', 'false'));
  }

  /** Plays a track, by name or index, or stops the one that plays. */
  play(which = 0) {
    if (this.playing) return this.stop();
    const { tracks } = this.notes,
      track = tracks.find((each) => each.name === which) ?? (Number.isInteger(which) ? tracks[which] : undefined);
    if (track) this.travel(track.stops, track.loop, true);
  }

  travel(stops, loop = false, tour = false) {
    this.viewer.spin(0);
    this.playing = { stops, loop, tour, at: -1, time: 0 };
    this.page.press('tour', tour);
    this.toward(0);
  }

  toward(i) {
    const { stops, loop } = this.playing;
    if (i >= stops.length && !loop) return this.stop();
    const at = i % stops.length,
      seconds = this.viewer.controls.smooth ? stops[at].seconds : 0;
    Object.assign(this.playing, { at, time: 0, seconds, said: false, from: { ...this.viewer.controls.pose }, to: this.poseOf(stops[at].view) });
    this.viewer.stage.redraw({ moving: true });
  }

  poseOf({ target, zoom, ...angles }) {
    const { pose } = this.viewer.controls,
      whole = fittingPose(this.viewer.stage.field, { ...pose, ...angles });
    const kept = fittingPose(this.viewer.stage.field, pose).distance / pose.distance;
    return { ...whole, distance: whole.distance / (zoom ?? kept), target: target ?? pose.target };
  }

  stop() {
    if (this.playing?.tour) this.page.press('tour', false);
    this.playing = null;
  }

  /** Before a frame. @returns whether it moves */
  tick(seconds) {
    const { playing } = this;
    if (!playing) return false;
    const stop = playing.stops[playing.at];
    playing.time += Math.min(seconds, 0.1);
    const share = playing.seconds > 0 ? Math.min(1, playing.time / playing.seconds) : 1;
    Object.assign(this.viewer.controls.pose, blendedPose(playing.from, playing.to, share * share * (3 - 2 * share)));
    if (share === 1 && !playing.said && stop.annotation !== null) this.show(stop.annotation, false);
    playing.said ||= share === 1;
    if (playing.time >= playing.seconds + stop.pause) this.toward(playing.at + 1);
    return this.playing !== null;
  }

  /** After a frame: marks to where their points are. */
  lay() {
    const { stage } = this.viewer;
    if (!this.marks.length || !stage.field || !(stage.pose || stage.camera)) return;
    const { clientWidth: width, clientHeight: height } = stage.canvas,
      view = stage.view(width, height);
    this.notes.annotations.forEach(({ at }, i) => {
      const pixel = pixelOf(view, at);
      this.marks[i].hidden = !pixel;
      if (pixel) Object.assign(this.marks[i].style, { left: `${pixel[0]}px`, top: `${pixel[1]}px` });
    });
    this.occlude(view.eye);
  }

  /** As many marks as a frame has time for are asked whether the object is before them; the rest in the next. */
  occlude(eye) {
    const { packed } = this.viewer.stage,
      key = eye.join();
    if (key === this.askedFrom && this.left === 0) return;
    if (key !== this.askedFrom) this.left = this.marks.length;
    this.askedFrom = key;
    const now = Math.min(this.left, Math.max(1, Math.floor(BUDGET / packed.points)));
    for (let n = 0; n < now; ++n) {
      const i = this.asked++ % this.marks.length,
        origin = eye.map((x, k) => (x - packed.centre[k]) / packed.step);
      const way = this.notes.annotations[i].at.map((x, k) => (x - eye[k]) / packed.step),
        length = Math.hypot(...way);
      const met = pick(packed, origin, way.map((x) => x / length));
      this.marks[i].classList.toggle('behind', met !== null && met.distance < length - SLACK);
    }
    this.left -= now;
    if (this.left > 0) this.viewer.stage.redraw();
  }
}
