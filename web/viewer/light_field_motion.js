// SPDX-License-Identifier: Apache-2.0
// A light field that moves in a scene of three.js: the viewer's player, driven by the application's clock.
//
// The application calls update() as it calls that of an AnimationMixer. three would call onBeforeRender by itself, but
// for every camera and pass, and not at all where the object is out of sight: that is no clock. Frames come from a
// worker, so a jump is not done when it was asked for: setTime() and setFrame() give a promise.
import { FramePlayer } from './player.js';
import { ViewerError } from './packed_field.js';

const ROUNDING = 1e-6; // seconds: a time that was computed may lie that far before its frame

export class LightFieldMotion {
  #show; #end;
  #place = 0; // of the frame that shows
  #seeking = null; // {promise, resolve, reject} of the jumps that are not shown yet
  #over = null; // why nothing moves any more

  /**
   * @param {import('./frame_source.js').FrameSource} source  whose first frame shows
   * @param {(frame: {packed, info}) => void} show  another  @param {() => void} end  what decodes them
   */
  constructor(source, show, end) {
    this.source = source;
    this.objects = new Set(); // that hear of it: all that share it
    this.#show = show;
    this.#end = end;
    this.player = new FramePlayer(source, {
      show: (answer, frame) => this.#shows(answer, frame),
      failed: (error, { place, number }) => this.#tell({ type: 'frameerror', frame: place, number, error }),
      sought: (error, there) => this.#sought(error ?? (there ? null : new ViewerError('damaged', 'The file ends before this frame.'))),
      stopped: (error) => this.#stopped(error),
      finished: () => this.#tell({ type: 'ended' }),
    });
    source.changed = () => this.player.arrived();
    this.player.begin(0);
  }

  play() {
    if (!this.#over && !this.player.playing) this.player.play();
  }

  update(seconds) {
    if (!(seconds >= 0 && seconds < Infinity)) throw new RangeError(`update(${seconds}): seconds since the last call, 0 or more`);
    return this.player.tick(seconds);
  }

  setTime(seconds) {
    if (!Number.isFinite(seconds)) throw new RangeError(`setTime(${seconds}): seconds from the first frame`);
    const { loop, duration } = this.player,
      laps = loop && this.source.ended ? Math.floor(seconds / duration) : 0;
    return this.#seek(this.#placeAt(seconds - laps * duration));
  }

  setFrame(place) {
    const { length } = this.source.list;
    if (!(Number.isInteger(place) && place >= 0 && place < length))
      throw new RangeError(`setFrame(${place}): ${length} frames have arrived, from 0 on`);
    return this.#seek(place);
  }

  /** What is being decoded is given up. */
  dispose() {
    if (this.#over) return;
    this.#over = new DOMException('The light field was disposed of.', 'AbortError');
    this.source.changed = () => {};
    this.player.pause();
    this.#end();
    this.#sought(this.#over);
  }

  /** The last frame that begins at a time or before it. */
  #placeAt(seconds) {
    const { list } = this.source,
      latest = list[0].time + seconds + ROUNDING;
    let low = 0,
      high = list.length;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (list[middle].time <= latest) low = middle;
      else high = middle;
    }
    return low;
  }

  #seek(place) {
    if (this.#over) return refused(this.#over);
    if (!this.#seeking && place === this.#place && place === this.player.frame) return Promise.resolve(place);
    this.#seeking ??= pending();
    const { promise } = this.#seeking;
    this.player.seek(place);
    return promise;
  }

  #shows(answer, frame) {
    if (this.#over) return;
    const { place, number, time } = frame;
    this.#place = place;
    this.#show(answer);
    this.#tell({ type: 'framechange', frame: place, number, time });
  }

  /** A jump is over. */
  #sought(error) {
    const seeking = this.#seeking;
    this.#seeking = null;
    if (error) seeking?.reject(error);
    else seeking?.resolve(this.#place);
  }

  #stopped(error) {
    this.#sought(error);
    this.#tell({ type: 'error', error });
  }

  /** What a listener throws is the page's, and stops no player. */
  #tell(event) {
    for (const object of this.objects) queueMicrotask(() => object.dispatchEvent({ ...event }));
  }
}

function pending() {
  const made = {};
  made.promise = quiet(new Promise((resolve, reject) => Object.assign(made, { resolve, reject })));
  return made;
}

const refused = (error) => quiet(Promise.reject(error));

/** Who calls setTime() for every picture waits for none: what is wrong is an event, too. */
function quiet(promise) {
  promise.catch(() => {});
  return promise;
}
