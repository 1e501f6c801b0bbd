// SPDX-License-Identifier: Apache-2.0
// When which frame shows. Frames are decoded ahead into a short queue; where that takes longer than they last, frames
// are left out, so that what shows is of its time. No DOM, no graphics.

const AHEAD = 4, // frames
  AHEAD_BYTES = 2 ** 28, // of packed frames, beyond which no other is decoded ahead
  LOOKED_AT = 64, // frames that are compared at least: several laps of a short file
  LONGEST = 0.25, // seconds of the clock between two ticks: where pictures take longer, what moves slows down
  USUAL = 1 / 30; // seconds of a frame, of a file that has one

const sizeOf = (packed) => Object.values(packed).reduce((sum, each) => sum + (ArrayBuffer.isView(each) ? each.byteLength : 0), 0);

export class FramePlayer {
  #turn = 0; // of a jump: what was asked for before it comes too late
  #asked = null; // what is being decoded
  #last = null; // what was asked for last, {lap, place}; lap 0 is the one that shows, 1 the next through the file
  #decoded = null; // place that the decoder is at
  #wanted = null; // place of a jump that is not shown yet
  #queue = []; // [{lap, place, time, packed, info, bytes}], ascending
  #position = 0; // seconds since the first frame of this lap
  #cost = 0; // seconds that a frame takes to decode
  #damaged = new Map(); // group: its first frame that cannot be decoded

  /**
   * @param source  FrameSource, or what has list, ended, groupOf and decode as it: {packed, info, seconds}
   * @param {object} on  show(answer, frame); failed(error, frame): it is passed over; stopped(error): there is no
   *   more to come; sought(error, there): a jump is over, and its frame shows, or is damaged, or not there; changed(): of
   *   state or list; finished(): the last frame was shown, and there is no loop
   * @param {object} options  loop, speed
   */
  constructor(source, on, { loop = true, speed = 1 } = {}) {
    Object.assign(this, { source, on, loop });
    this.playing = false;
    this.shown = null; // place
    this.dropped = 0; // frames that were left out since play()
    this.setSpeed(speed);
  }

  get frame() { return this.#wanted ?? this.shown ?? 0; }

  /** Seconds of the frames that have arrived; all of them, where source.ended. */
  get duration() {
    const { list } = this.source;
    return list.length ? this.#timeOf(list.length - 1) + this.#interval() : 0;
  }

  /** Seconds of the frame that shows from the first. */
  get time() { return this.source.list.length ? this.#timeOf(this.frame) : 0; }

  setSpeed(speed) { this.speed = Math.min(16, Math.max(1 / 16, Number.isFinite(Number(speed)) ? Number(speed) : 1)); }

  setLoop(loop) {
    this.loop = loop;
    if (!loop) this.#queue = this.#queue.filter((each) => each.lap === 0);
    if (this.shown !== null) this.#last = this.#queue.at(-1) ?? { lap: 0, place: this.shown };
    this.#ask();
  }

  /** From the beginning, where the end was reached. */
  play() {
    const { list, ended } = this.source;
    if (ended && !this.loop && this.frame === list.length - 1) this.seek(0);
    this.playing = true;
    this.dropped = 0;
    this.on.changed?.();
    this.#ask();
  }

  pause() {
    this.playing = false;
    this.on.changed?.();
  }

  /** Shows a frame that has arrived, and goes on from there. */
  seek(place) {
    const { list } = this.source;
    if (!list.length || !Number.isFinite(place)) return;
    this.#wanted = Math.max(0, Math.min(list.length - 1, Math.round(place)));
    this.#position = this.#timeOf(this.#wanted);
    this.#queue = [];
    ++this.#turn;
    this.on.changed?.();
    this.#ask();
  }

  step(frames) {
    this.pause();
    this.seek(this.frame + frames);
  }

  /** What was decoded elsewhere and shows. */
  begin(place) {
    this.shown = place;
    this.#position = this.#timeOf(place);
    this.#last = { lap: 0, place };
    this.#decoded = place;
  }

  /** Moves the clock on. @returns {boolean} whether it runs */
  tick(seconds) {
    if (!this.playing) return false;
    if (this.#wanted !== null || this.shown === null) return true; // it waits for the frame of a jump
    this.#position += Math.min(seconds, LONGEST) * this.speed;
    const { list, ended } = this.source;
    if (!ended) this.#position = Math.min(this.#position, this.#timeOf(list.length - 1)); // and for what is on its way
    if (ended && this.loop && this.#position >= this.duration) this.#wrap();
    let due = null;
    while (this.#queue.length && this.#queue[0].time <= this.#position) {
      if (due) ++this.dropped;
      due = this.#queue.shift();
    }
    if (due) this.#show(due);
    if (ended && !this.loop && this.#position >= this.duration) {
      const last = list.length - 1;
      if (this.shown === last || this.#isLost(last)) return this.#finish();
      this.seek(last); // it is late: the end shows it all the same
    }
    this.#ask();
    return true;
  }

  /** More frames have arrived. */
  arrived() {
    this.on.changed?.();
    this.#ask();
  }

  /** A lap is over, or several: the next is the first. */
  #wrap() {
    const { duration } = this,
      laps = Math.floor(this.#position / duration);
    this.#position -= laps * duration;
    for (const each of this.#queue) each.time -= laps * duration;
    for (const each of [...this.#queue, this.#asked, this.#last]) if (each) each.lap -= laps;
    if (this.#last.lap < 0) this.#last = { lap: 0, place: -1 };
  }

  #finish() {
    this.playing = false;
    this.#position = this.#timeOf(this.source.list.length - 1);
    this.on.finished?.();
    this.on.changed?.();
    return false;
  }

  #timeOf(place) { return this.source.list[place].time - this.source.list[0].time; }
  #timeIn({ lap, place }) { return lap * this.duration + this.#timeOf(place); }

  #interval() {
    const { length } = this.source.list;
    return length > 1 ? this.#timeOf(length - 1) / (length - 1) : USUAL;
  }

  #show({ place, packed, info }) {
    this.shown = place;
    this.on.show({ packed, info }, this.source.list[place]);
  }

  #ask() {
    if (this.#asked) return;
    const next = this.#wanted !== null ? { lap: 0, place: this.#wanted, frames: this.#framesTo(this.#wanted) } : this.#next();
    if (!next) return;
    const asked = (this.#asked = { ...next, turn: this.#turn, wanted: this.#wanted });
    this.source.decode(next.place).then(
      (answer) => this.#answered(asked, answer, null),
      (error) => this.#answered(asked, null, error),
    );
  }

  #answered(asked, answer, error) {
    const { lap, place, frames } = asked, // a lap may have ended since
      here = asked.turn === this.#turn;
    this.#asked = null;
    if (error?.name === 'AbortError') return;
    if (error && error.kind !== 'damaged') return this.#stop(error);
    if (answer) {
      const spent = answer.seconds / frames;
      this.#cost = this.#cost ? 0.7 * this.#cost + 0.3 * spent : spent;
    }
    this.#decoded = answer ? place : null;
    if (here) this.#last = { lap, place };
    if (error) this.#fail(error, place);
    else if (answer && (asked.wanted !== null)) this.#show({ place, ...answer }); // what a hand has passed by shows, too
    else if (answer && here && (this.loop || lap === 0)) this.#queue.push({ lap, place, time: this.#timeIn(asked), bytes: sizeOf(answer.packed), ...answer });
    if (here && asked.wanted !== null) {
      this.#wanted = null;
      this.on.sought?.(error, answer !== null);
    }
    this.on.changed?.();
    this.#ask();
  }

  /** What is wrong with one frame only can be passed over. */
  #stop(error) {
    this.#wanted = null;
    this.pause();
    this.on.stopped?.(error);
  }

  /** Frames behind it in its group are passed over. */
  #fail(error, place) {
    const group = this.source.groupOf(place);
    this.#damaged.set(group, Math.min(place, this.#damaged.get(group) ?? Infinity));
    if (this.#wanted === place) this.shown = place; // the clock goes on from there
    this.on.failed?.(error, this.source.list[place]);
  }

  #isLost(place) { return place >= (this.#damaged.get(this.source.groupOf(place)) ?? Infinity); }

  /** What to decode now: the first frame that will be there in its time; where there is none, the one that is least late. */
  #next() {
    const queued = this.#queue.reduce((sum, each) => sum + each.bytes, 0);
    if (!this.playing || this.#last === null || this.#queue.length >= AHEAD || queued > AHEAD_BYTES) return null;
    const most = Math.max(this.source.list.length, LOOKED_AT);
    let best = null,
      left = 0;
    for (let at = this.#after(this.#last), seen = 0; at && seen < most; at = this.#after(at), ++seen) {
      if (this.#isLost(at.place)) continue;
      const frames = this.#framesTo(at.place),
        early = this.#timeIn(at) - this.#position - frames * this.#cost * this.speed;
      if (best === null || early > best.early) best = { ...at, frames, early, left };
      if (early >= 0) break;
      ++left;
    }
    if (best) this.dropped += best.left;
    return best;
  }

  /** Frames to decode for one: from where the decoder is, or from the beginning of its group. */
  #framesTo(place) {
    const group = this.source.groupOf(place),
      goesOn = this.#decoded !== null && this.#decoded >= group && this.#decoded < place;
    return goesOn ? place - this.#decoded : place - group + 1;
  }

  #after({ lap, place }) {
    const { list, ended } = this.source;
    if (place + 1 < list.length) return { lap, place: place + 1 };
    return ended && this.loop && list.length > 1 ? { lap: lap + 1, place: 0 } : null;
  }
}
