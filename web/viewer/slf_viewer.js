// SPDX-License-Identifier: Apache-2.0
// <slf-viewer src="can.slf">: the viewer as an element of any page, as many as there are. viewer/README.md has the
// list of attributes, which is that of the address of viewer.html.
//
//     <script type="module">import 'slf-decoder/viewer/slf_viewer.js'</script>
//     <slf-viewer src="can.slf" poster="can.jpg" azimuth="40"></slf-viewer>
import { frameIn } from './element_frame.js';
import { Elements } from './elements.js';
import { FieldLoader } from './field_loader.js';
import { missingCard, missingPart } from './missing_part.js';
import { backgroundOf, readOptions } from './options.js';
import { Viewer } from './viewer.js';
import { addressOf, viewOfAddress, viewParameters } from './view_link.js';
import { Turns } from './viewer_turns.js';
import { wordsOf } from './words.js';

const LIVE = ['background', 'exposure', 'mean', 'points', 'autorotate', 'loop', 'speed']; // that change what is shown at once
const turns = new Turns();

// web/build.sh makes it. Where a page lacks it, a static import would leave every viewer empty, without a word.
let made; // markup and style; null: they did not arrive
const arriving = import('../made/viewer_markup.js').then((parts) => (made = parts), () => (made = null));

export class SlfViewerElement extends HTMLElement {
  static observedAttributes = ['src', ...LIVE];

  /** Where the package's files are, for every viewer; SLFLoader has the same options. */
  static parts = {};

  #elements = null;
  #starting = null; // a promise of the viewer
  #view = null; // parameters that come before the attributes
  #opened = null; // of open(), in place of src
  #still = null; // address of its last picture
  #query = { get: (name) => this.#view?.get(name) ?? this.getAttribute(name) };

  constructor() {
    super();
    this.attachShadow({ mode: 'open' });
    this.viewer = null; // while it is shown
  }

  connectedCallback() {
    this.#markUp();
    const named = viewOfAddress(this.id);
    if (named) this.#visit(named);
    turns.watch(this, named !== null);
    addEventListener('hashchange', this.#hashChanged);
  }

  disconnectedCallback() {
    removeEventListener('hashchange', this.#hashChanged);
    turns.forget(this);
    this.sleep();
  }

  attributeChangedCallback(name, before, value) {
    if (!this.isConnected || (name === 'src' && before === value)) return; // a hand may have changed the others
    this.#view?.delete(name);
    if (name === 'src') this.#reopen();
    else if (this.viewer?.stage) this.#look(name);
  }

  // What turns.js calls: a page has few graphics contexts and many viewers.

  /** Loads and shows. @returns {Promise<Viewer|null>} */
  wake() {
    if (this.#starting) return this.#starting;
    const begun = this.#start().catch((error) => error).then((result) => {
      const viewer = result instanceof Error ? null : result;
      if (!viewer && this.#starting === begun) this.#starting = null; // it can be begun again
      if (result instanceof Error) this.#emit('error', result);
      return viewer;
    });
    return (this.#starting = begun);
  }

  /** Lets go of the worker, the memory and the context; its last picture stays. */
  async sleep() {
    const { viewer } = this;
    this.#starting = this.viewer = null;
    if (!viewer) return;
    if (viewer.controls?.pose) this.#view = new URLSearchParams(viewParameters(viewer));
    const picture = viewer.stage?.field && viewer.stage.canvas.isConnected ? viewer.stage.screenshot() : null;
    const still = await picture;
    viewer.dispose();
    if (this.#starting) return; // it is wanted again
    URL.revokeObjectURL(this.#still);
    this.#still = still && URL.createObjectURL(still);
    this.#markUp(this.#still ?? undefined);
  }

  // For pages

  /** An address, a File or bytes in place of `src`. Resolves when it shows, or what is wrong does. */
  async open(source, name) {
    const awake = this.viewer;
    this.#opened = { source, name };
    const viewer = await this.wake();
    return awake ? viewer.open(source, name) : viewer?.opening;
  }

  /** idle, loading, coarse, ready, or failed and the kind of the error. */
  get state() {
    if (made === null) return 'failed network';
    return this.#elements?.frame.dataset.state ?? (this.viewer && (this.#opened || this.getAttribute('src')) ? 'loading' : 'idle');
  }

  /** Azimuth, elevation, fov, zoom and target as attributes have them; null before it shows. */
  get view() {
    return this.viewer?.controls?.pose ? viewParameters(this.viewer) : null;
  }

  set view(parameters) {
    this.#view = new URLSearchParams(parameters ?? {});
    if (!this.viewer?.controls?.pose) return;
    const { view, mode } = this.#options();
    Object.assign(this.viewer.options, view);
    this.viewer.reset();
    if (mode !== this.viewer.controls.mode) this.viewer.setMode(mode);
    this.#look('view');
  }

  /** The place of the object under a point of the window (`clientX`, `clientY`); null beside it. */
  pointAt(x, y) {
    return this.viewer?.ruler.under(x, y) ?? null;
  }

  /** What moves; with a track, by name or number, and where nothing moves, a tour of the notes, or stops the one that plays. */
  play(track) {
    if (track === undefined && this.#playback?.moves) this.#playback.play();
    else this.viewer?.guide.play(track ?? 0);
  }

  pause() {
    this.#playback?.pause();
  }

  /** Whether what moves stands still. */
  get paused() {
    return !this.#playback?.player?.playing;
  }

  /** Place of the frame that shows, from 0; set, it shows as soon as it is decoded. */
  get frame() {
    return this.#playback?.player?.frame ?? 0;
  }

  set frame(place) {
    this.#playback?.seek(Number(place));
  }

  /** Frames that have arrived; 0 where nothing moves. */
  get frames() {
    return this.#playback?.source?.list.length ?? 0;
  }

  /** Seconds of the frames that have arrived; 0 where nothing moves. */
  get duration() {
    return this.#playback?.player?.duration ?? 0;
  }

  get loop() {
    return this.#playback?.player?.loop ?? this.#options().loop;
  }

  set loop(on) {
    this.setAttribute('loop', on ? '1' : '0');
  }

  /** 1: as the file has it. */
  get speed() {
    return this.#playback?.player?.speed ?? this.#options().speed;
  }

  set speed(speed) {
    this.setAttribute('speed', speed);
  }

  get #playback() {
    return this.viewer?.playback;
  }

  /** Opens an annotation of the notes, by its number from 0. */
  show(annotation) {
    if (this.viewer?.guide.marks[annotation]) this.viewer.guide.show(annotation);
  }

  /** Whether clicks on the object measure it. */
  measure(on = true) {
    if (this.viewer?.stage?.field) this.viewer.ruler.toggle(on);
  }

  reset() {
    if (this.viewer?.stage?.field) this.viewer.reset();
  }

  fit() {
    if (this.viewer?.stage?.field) this.viewer.fit();
  }

  spin(speed = 12) {
    this.viewer?.spin(speed);
  }

  /** @returns {Promise<Blob|null>} PNG */
  async picture() {
    return this.viewer?.stage?.field ? this.viewer.stage.screenshot() : null;
  }

  /** Into a room of WebXR, 'vr' or 'ar', or out of it. A hand has to ask for it: browsers refuse it otherwise. */
  async toggleRoom(kind) {
    await this.viewer?.rooms.toggle(kind);
  }

  async #start() {
    await arriving;
    if (!made) throw missingPart();
    if (!this.isConnected || this.viewer) return this.viewer;
    this.#markUp(this.#still ?? undefined);
    const words = await this.#words();
    if (!this.isConnected || this.viewer) return this.viewer;
    const frame = this.#elements.frame;
    frame.classList.remove('asleep');
    frame.classList.toggle('empty', !this.#opened && !this.getAttribute('src'));
    this.#elements = new Elements(this.shadowRoot, frame, words);
    const source = this.#opened, page = { scroll: 'polite' };
    const loader = new FieldLoader(SlfViewerElement.parts);
    if (source) Object.assign(page, { file: source.source, name: source.name });
    this.viewer = new Viewer({ ...page, loader }, {
      elements: this.#elements,
      query: this.#query,
      link: this.id ? (parameters) => addressOf(this.id, parameters) : null,
      emit: (name, detail) => this.#emit(name, detail),
    });
    return this.viewer;
  }

  #words() {
    return wordsOf([this.getAttribute('lang') ?? this.closest('[lang]')?.lang, ...navigator.languages].filter(Boolean));
  }

  #hashChanged = () => {
    const named = viewOfAddress(this.id);
    if (named) this.#visit(named);
  };

  /** A view that the address names. */
  #visit(view) {
    this.view = view;
    const show = () => this.scrollIntoView({ block: 'center' });
    if (document.readyState === 'complete') show();
    else addEventListener('load', show, { once: true });
  }

  async #reopen() {
    this.#opened = this.#view = null;
    await this.sleep();
    URL.revokeObjectURL(this.#still); // of the file before
    this.#still = null;
    if (!this.isConnected) return; // connectedCallback() goes on
    this.#markUp();
    turns.forget(this);
    turns.watch(this);
  }

  #options() {
    const read = readOptions(this.#query), { azimuth, elevation, fov, zoom, target } = read;
    return { ...read, view: { azimuth, elevation, fov, zoom, target } };
  }

  #look(changed) {
    const { viewer } = this, { background, exposure, mean, points, autorotate, loop, speed } = this.#options();
    if (changed === 'loop') return viewer.playback.setLoop(loop);
    if (changed === 'speed') return viewer.playback.setSpeed(speed);
    Object.assign(viewer.options, { background, exposure, mean, points, autorotate });
    viewer.chosen = backgroundOf(this.#query.get('background'));
    if (viewer.chosen) viewer.background = viewer.chosen;
    viewer.followPage();
    viewer.applyLook();
    if (changed === 'autorotate') viewer.spin(viewer.controls?.smooth ? autorotate : 0);
    viewer.stage.redraw();
  }

  /** The elements as they are before anything is shown. */
  #markUp(still = this.getAttribute('poster')) {
    if (made === undefined) return void arriving.then(() => this.isConnected && !this.#elements && this.#markUp());
    if (made === null) return void this.#words().then((words) => missingCard(this.shadowRoot, words));
    this.#elements = new Elements(this.shadowRoot, frameIn(this.shadowRoot, made));
    if (still) this.#elements.writePoster(still);
  }

  #emit(name, detail) {
    this.dispatchEvent(new CustomEvent(name, { detail }));
  }
}

if (!customElements.get('slf-viewer')) customElements.define('slf-viewer', SlfViewerElement);
