// SPDX-License-Identifier: Apache-2.0
// The viewer page: viewer.html's elements to a Stage (what is drawn), Controls (hands) and a
// FieldLoader (bytes). `slf html` makes pages of the same parts.
import { Comparison } from './comparison.js';
import { Controls } from './controls.js';
import { deviceFacts, isHandheld } from './device.js';
import { Elements, download } from './elements.js';
import { FieldLoader } from './field_loader.js';
import { Guide } from './guide.js';
import { Playback } from './playback.js';
import { backgroundColour, BACKGROUNDS, OF_FIRST_FILE, readOptions } from './options.js';
import { Report } from './report.js';
import { Rooms } from './rooms.js';
import { Ruler } from './ruler.js';
import { Stage } from './stage.js';
import { fittingPose, namedPose, poseOfCamera } from './view.js';
import { Wiring } from './wiring.js';

export class Viewer {
  /**
   * @param {object} page  defaults of options.js, and loader: a FieldLoader, file: bytes, name
   * @param {object} place  elements: Elements; query: what the address says; link(parameters): address of a view, null
   *   where there is none; emit(name, detail): tells a page about it
   */
  constructor(page = {}, { elements = new Elements(), query = new URLSearchParams(location.search), link, emit } = {}) {
    this.options = readOptions(query, page);
    this.page = elements;
    this.link = link === undefined ? addressOfPage : link;
    this.emit = emit ?? (() => {});
    this.screen = elements.whole ? document.documentElement : elements.frame;
    this.loader = page.loader ?? new FieldLoader();
    Object.assign(this.loader, { maxMemory: this.options.memory, groupsFirst: isHandheld(deviceFacts()) });
    this.report = new Report(this);
    this.comparison = new Comparison(this);
    this.guide = new Guide(this);
    this.ruler = new Ruler(this);
    this.playback = new Playback(this);
    this.rooms = new Rooms(this);
    this.facts = {};
    this.chosen = this.options.background; // null: as the page and the hour have it
    this.background = this.chosen ?? (this.darkPage() ? 'slate' : 'paper');
    this.page.frame.classList.toggle('embed', this.options.embed);
    this.wiring = new Wiring(this);
    this.paintBackground();
    try {
      this.stage = new Stage(this.page.at('stage'), {
        tick: (seconds) => this.tick(seconds),
        drawn: () => this.report.afterDrawing(),
        lost: () => this.report.say('The graphics context was lost.'),
        restored: (error) => (error ? this.report.fail(error) : this.report.say('The graphics context is back.')),
      });
    } catch (error) {
      this.report.fail(error);
      return;
    }
    this.loader.maxPoints = this.stage.mostPoints;
    this.controls = new Controls(this.page.at('stage'), {
      change: () => this.moved(),
      start: () => {
        this.touched = true;
        this.guide.stop();
        this.spin(0);
      },
      refused: (text) => this.report.hint(text),
    });
    this.controls.setPolite(this.options.scroll === 'polite');
    this.setMode(this.options.mode);
    this.paintBackground();
    this.applyLook();
    const { poster, src } = this.options;
    if (poster) this.page.writePoster(poster);
    if (page.file) this.opening = this.open(page.file, page.name);
    else if (src) this.opening = this.open(src, src.split(/[?#]/)[0].split('/').pop());
    else if (poster) this.page.writePoster(null);
  }

  /** @param source  of FieldLoader.load(). Resolves when it shows, or an error does. */
  async open(source, name = '') {
    if (!this.stage) return;
    const begin = performance.now();
    this.report.hideProblem();
    this.page.frame.classList.remove('empty');
    if (this.source && this.source.source !== source) Object.assign(this.options, OF_FIRST_FILE);
    const own = (this.source = this.loading = { source, name });
    this.options.all = false;
    this.comparison.close();
    this.guide.close();
    this.ruler.toggle(false);
    this.playback.close();
    this.controls.pose = null;
    this.touched = false;
    this.stage.clear();
    this.facts = { name };
    this.page.at('title').textContent = this.report.titleText();
    this.report.arriving(0, 0);
    try {
      const on = {
        progress: (received, total) => this.report.arriving(received, total),
        field: (packed, info, final, coarser) => this.show(packed, info, final, begin, coarser),
        moving: (frames) => this.playback.open(frames),
      };
      const loading = this.loader.load(source, on, this.options); // sliders may move while the file arrives
      const { bytes, part } = await loading.finally(() => {
        if (this.source === own) this.loading = null;
      });
      this.facts.bytes ||= bytes;
      this.playback.start();
      this.facts.loaded = performance.now() - begin;
      this.report.describe();
      this.report.say('It is shown.');
      if (Object.entries(part).some(([name, value]) => this.options[name] !== value)) await this.decodeAgain();
      if (this.options.notes) await this.guide.open(this.options.notes);
      else await this.guide.openOwn(this.facts.info?.metadata);
      if (this.options.capture) await this.comparison.open(this.options.capture);
    } catch (error) {
      if (error.name !== 'AbortError') this.report.fail(error);
    } finally {
      if (this.source === own) this.page.at('progress').hidden = true;
    }
  }

  /** @param coarser  of FieldLoader.load() */
  show(packed, info, final, begin, coarser) {
    const first = !this.stage.field || !this.controls.pose;
    Object.assign(this.facts, { info, coarser });
    this.stage.setField(packed);
    this.report.hideProblem(); // of a decode before
    this.page.frame.classList.remove('empty');
    this.facts.first ??= performance.now() - begin;
    this.facts.final = final;
    this.controls.up = packed.up;
    this.controls.radius = packed.radius;
    if (first || (final && !this.touched)) this.reset();
    this.page.writePoster(null);
    if (final && this.controls.smooth && this.options.autorotate) this.spin(this.options.autorotate);
    this.report.describe();
    this.page.frame.dataset.state = final ? 'ready' : 'coarse';
    if (final) this.rooms.offer();
    this.emit(final ? 'ready' : 'coarse', { points: packed.points, coarser: coarser ?? null });
  }

  /** Frees the worker, the graphics context and what listens outside. */
  dispose() {
    this.source = null; // what is on its way finds another
    this.rooms.end();
    this.loader.dispose();
    this.controls?.dispose();
    this.stage?.dispose();
    this.wiring.dispose();
  }

  /** Decodes the same file with other levels, groups or layers; when it is here, where it is still on its way. */
  async decodeAgain(part) {
    Object.assign(this.options, part);
    if (this.playback.moves && !this.loading) return this.playback.again();
    if (this.loading || !this.loader.whole) return;
    const { source } = this,
      begin = performance.now();
    this.report.say('Decoding …');
    try {
      const { packed, info, coarser } = await this.loader.decode(this.options);
      if (this.source !== source) return;
      if (!this.controls.pose) return this.show(packed, info, true, begin, coarser); // all of it was too much
      Object.assign(this.facts, { info, coarser });
      this.stage.setField(packed);
      this.report.hideProblem();
      this.page.frame.dataset.state = 'ready';
      this.report.describe();
      this.report.say('Decoded.');
    } catch (error) {
      if (error.name !== 'AbortError') this.report.fail(error);
    }
  }

  // Views

  /** Of a unit of the file's world; 0: nobody knows. */
  get metres() {
    return this.options.metres || this.facts.info?.metresPerUnit || 0;
  }

  startPose() {
    const { azimuth, elevation, fov, zoom, target, view } = this.options;
    if (view) return poseOfCamera({ ...view, rotation: view.rotation }, this.stage.field);
    const own = azimuth === null && elevation === null && !target ? namedPose(this.stage.field, this.facts.info?.metadata) : null;
    if (own) return { ...own, distance: own.distance / zoom };
    const pose = fittingPose(this.stage.field, { azimuth: azimuth ?? 30, elevation: elevation ?? 20, fov });
    return { ...pose, distance: pose.distance / zoom, target: target ?? pose.target };
  }

  reset() {
    this.comparison.leave();
    this.controls.pose = this.stage.pose = this.startPose();
    this.page.at('fov').value = Math.round(this.controls.pose.fov);
    this.moved();
  }

  fit() {
    const { azimuth, elevation, fov } = this.controls.pose;
    this.comparison.leave();
    this.controls.pose = this.stage.pose = fittingPose(this.stage.field, { azimuth, elevation, fov });
    this.moved();
  }

  moved() {
    this.emit('viewchange');
    if (this.comparison.shown) this.comparison.leave();
    this.stage.redraw({ moving: true });
  }

  /** Degrees a second; 0 stops. */
  spin(speed) {
    this.spinning = speed;
    this.page.press('spin', speed !== 0);
    this.stage?.redraw({ moving: true });
  }

  tick(seconds) {
    const moved = this.controls.tick(seconds);
    let moving = (this.controls.pose !== null && this.guide.tick(seconds)) || moved;
    moving = this.playback.tick(seconds) || moving;
    if (this.spinning && this.controls.pose && !document.hidden) {
      this.controls.pose.azimuth += this.spinning * Math.min(seconds, 0.1);
      moving = true;
    }
    return moving;
  }

  setMode(mode) {
    this.controls.mode = mode;
    this.page.one(`input[name=mode][value=${mode}]`).checked = true;
    this.report.say(mode === 'fly' ? 'Fly: W A S D Q E and drag.' : 'Orbit.');
  }

  // Looks

  /** Whether the page around it is dark: by its `color-scheme`, else by what its reader prefers. */
  darkPage() {
    const scheme = this.page.whole ? '' : getComputedStyle(this.page.root.host).colorScheme;
    if (/^(only )?dark/.test(scheme)) return true;
    return scheme !== 'light' && matchMedia('(prefers-color-scheme: dark)').matches;
  }

  /** As the page is now, where nobody has chosen. */
  followPage() {
    if (this.chosen === null) this.background = this.darkPage() ? 'slate' : 'paper';
    this.paintBackground();
  }

  applyLook() {
    const { options, stage } = this;
    this.page.at('exposure').value = options.exposure;
    this.page.at('mean').checked = options.mean;
    this.page.at('points').value = options.points;
    Object.assign(stage.look, { exposure: options.exposure, meanOnly: options.mean, share: options.points / 100 });
    this.page.writeOutputs();
  }

  paintBackground() {
    const colour = backgroundColour(this.background);
    this.page.writeTheme(this.background, colour, this.darkPage());
    if (!this.stage) return;
    this.stage.look.background = colour;
    this.stage.redraw();
  }

  async save() {
    download(await this.stage.screenshot(), `${(this.report.titleText() || 'light field').replace(/[^\w.-]+/g, '_')}.png`);
  }

  togglePanel() {
    const hidden = !this.page.at('panel').hidden;
    this.page.at('panel').hidden = hidden;
    this.page.frame.classList.toggle('open', !hidden);
    this.page.one('[data-do=panel]').setAttribute('aria-expanded', String(!hidden));
  }

  nextBackground() {
    const names = Object.keys(BACKGROUNDS);
    this.chosen = this.background = names[(names.indexOf(this.background) + 1) % names.length];
    this.paintBackground();
  }

  /** What the device's memory has left out, whatever it takes. */
  openAll() {
    return this.decodeAgain({ all: true });
  }

  openCoarser() {
    const most = this.facts.info?.levels ?? 9;
    this.options.levels = Math.max(1, Math.min(this.options.levels || most, most) - 2);
    this.open(this.source.source, this.source.name);
  }
}

/** The page's own address with a view in it. */
function addressOfPage(parameters) {
  const address = new URL(location.href);
  for (const [name, value] of Object.entries(parameters)) address.searchParams.set(name, value);
  return address.href;
}
