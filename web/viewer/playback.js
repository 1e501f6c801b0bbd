// SPDX-License-Identifier: Apache-2.0
// The bar of a light field that moves: play, pause, a slider over its frames, speed, loop; and what it tells a page.
import { FramePlayer } from './player.js';

const SPEEDS = [0.25, 0.5, 1, 2];

export class Playback {
  #shownAt = -1; // place that the bar says
  #goesOn = false; // what plays is decoded anew, once or several times, and plays on

  /** @param {import('./viewer.js').Viewer} viewer */
  constructor(viewer) {
    this.viewer = viewer;
    this.page = viewer.page;
    this.player = null; // while the light field moves
    this.source = null;
    this.listen();
  }

  get moves() { return this.player !== null; }

  /** @param {import('./frame_source.js').FrameSource} source  whose first frame is about to show */
  open(source) {
    const { loop, speed } = this.viewer.options;
    this.source = source;
    this.player = new FramePlayer(
      source,
      {
        show: (answer, frame) => this.show(answer, frame),
        failed: (error, frame) => this.fail(error, frame),
        changed: () => this.write(),
        stopped: (error) => this.viewer.report.fail(error),
        finished: () => this.viewer.emit('ended'),
      },
      { loop, speed },
    );
    source.changed = () => this.arrived();
    this.player.begin(0);
    this.writeFacts();
    this.page.frame.classList.add('moves');
    this.page.at('player').hidden = false;
    this.page.at('speed').value = SPEEDS.includes(this.player.speed) ? this.player.speed : '';
    this.write();
  }

  /** By itself, unless the reader or the page would rather not. */
  start() {
    this.#goesOn = false;
    if (this.viewer.controls.smooth && !this.viewer.options.paused) this.play();
  }

  /** The same frames with other levels, groups or layers, from where it is. */
  async again() {
    const { viewer } = this,
      { frame } = this.player;
    this.#goesOn ||= this.player.playing;
    this.player.pause();
    viewer.report.say('Decoding …');
    try {
      const source = await viewer.loader.openFrames(viewer.options);
      const answer = await source.decode(frame);
      if (source !== viewer.loader.frames || !answer) return;
      this.close();
      this.open(source);
      viewer.facts.coarser = source.coarser;
      this.player.begin(frame);
      this.show(answer, source.list[frame]);
      viewer.report.hideProblem();
      this.page.frame.dataset.state = 'ready';
      viewer.report.describe();
      viewer.report.say('Decoded.');
      if (this.#goesOn) this.play();
    } catch (error) {
      if (error.name !== 'AbortError') viewer.report.fail(error);
    }
  }

  close() {
    this.player?.pause();
    if (this.source) this.source.changed = () => {};
    this.player = this.source = null;
    this.#shownAt = -1;
    this.page.frame.classList.remove('moves');
    this.page.at('player').hidden = true;
    this.page.at('frame-problem').textContent = '';
  }

  tick(seconds) { return this.player?.tick(seconds) ?? false; }

  play() {
    this.#goesOn = false;
    if (!this.moves || this.player.playing) return;
    this.player.play();
    this.viewer.emit('play');
    this.viewer.stage.redraw({ moving: true });
  }

  pause() {
    this.#goesOn = false;
    if (!this.player?.playing) return;
    this.player.pause();
    this.viewer.emit('pause');
  }

  toggle() {
    if (this.player?.playing) this.pause();
    else this.play();
  }

  step(frames) {
    if (!this.moves) return;
    this.pause();
    this.player.step(frames);
  }

  seek(place) { this.player?.seek(place); }

  setLoop(loop) {
    this.viewer.options.loop = loop;
    this.player?.setLoop(loop);
    this.write();
  }

  setSpeed(speed) {
    this.viewer.options.speed = speed;
    this.player?.setSpeed(speed);
    this.page.at('speed').value = SPEEDS.includes(speed) ? speed : '';
  }

  show({ packed, info }, frame) {
    this.viewer.facts.info = info;
    this.viewer.stage.setField(packed);
    this.page.at('frame-problem').textContent = '';
    this.write();
    const { place, number, time } = frame;
    this.viewer.emit('framechange', { frame: place, number, time });
  }

  /** Said, and passed over: the picture before it stays until the next that is sound. */
  fail(error, { place, number }) {
    const text = this.page.t(`Frame ${number} is damaged.`);
    this.page.at('frame-problem').textContent = text;
    this.viewer.emit('frameerror', { frame: place, number, error });
    this.write();
  }

  arrived() {
    const { ended } = this.writeFacts();
    if (ended && this.viewer.stage.field) this.viewer.report.describe();
    this.player.arrived();
  }

  writeFacts() {
    const { list, ended, bytes } = this.source;
    Object.assign(this.viewer.facts, { frames: list.length, bytes: ended ? bytes : 0 });
    return this.source;
  }

  write() {
    const { player, page } = this;
    if (!player) return;
    const { playing, frame } = player,
      last = this.source.list.length - 1,
      scrub = page.at('scrub');
    const button = page.one('[data-do=playback]'),
      named = page.t(playing ? 'Pause' : 'Play');
    if (button.getAttribute('aria-label') !== named) {
      button.setAttribute('aria-label', named);
      button.title = page.t(playing ? 'Pause (Space)' : 'Play (Space)');
      button.classList.toggle('playing', playing);
    }
    page.press('loop', player.loop);
    if (Number(scrub.max) !== last) scrub.max = String(last);
    if (this.#shownAt === frame && page.at('played').dataset.last === String(last)) return;
    this.#shownAt = frame;
    scrub.value = String(frame);
    const seconds = (value) => page.decimal(value, 1);
    page.at('played').dataset.last = String(last);
    page.at('played').textContent = `${seconds(player.time)} / ${seconds(player.duration)} s`;
    scrub.setAttribute('aria-valuetext', page.t(`Frame ${frame + 1} of ${last + 1}`));
  }

  listen() {
    const { page } = this,
      scrub = page.at('scrub');
    scrub.addEventListener('input', () => this.seek(Number(scrub.value)));
    scrub.addEventListener('keydown', (event) => {
      const act = { ' ': () => this.toggle(), ',': () => this.step(-1), '.': () => this.step(1) }[event.key];
      if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      act();
    });
    page.at('speed').addEventListener('change', (event) => this.setSpeed(Number(event.target.value)));
  }
}
