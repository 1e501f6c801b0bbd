// The viewer page: viewer.html's elements to a Stage (what is drawn), Controls (hands) and a
// FieldLoader (bytes). `slf html` makes pages of the same parts.
import { Comparison } from './comparison.js';
import { Controls } from './controls.js';
import {
  at,
  download,
  grouped,
  press,
  sizeText,
  slider,
  writeFacts,
  writeOutputs,
  writePoster,
  writeProblem,
  writeProgress,
  writeTheme,
} from './elements.js';
import { FieldLoader } from './field_loader.js';
import { backgroundColour, BACKGROUNDS, OF_FIRST_FILE, readOptions } from './options.js';
import { ViewerError } from './packed_field.js';
import { Stage } from './stage.js';
import { fittingPose, poseOfCamera } from './view.js';
import { Wiring } from './wiring.js';

export class Viewer {
  /** @param {object} page  defaults of options.js, and loader: a FieldLoader, file: bytes, name */
  constructor(page = {}) {
    this.options = readOptions(new URLSearchParams(location.search), page);
    this.loader = page.loader ?? new FieldLoader({ maxMemory: this.options.memory });
    this.comparison = new Comparison(this);
    this.facts = {};
    this.background =
      this.options.background ?? (matchMedia('(prefers-color-scheme: dark)').matches ? 'slate' : 'paper');
    document.body.classList.toggle('embed', this.options.embed);
    this.wiring = new Wiring(this);
    this.paintBackground();
    try {
      this.stage = new Stage(at('stage'), {
        tick: (seconds) => this.tick(seconds),
        drawn: () => this.afterDrawing(),
        lost: () => this.say('The graphics context was lost.'),
        restored: (error) => (error ? this.fail(error) : this.say('The graphics context is back.')),
      });
    } catch (error) {
      this.fail(error);
      return;
    }
    this.controls = new Controls(at('stage'), {
      change: () => this.moved(),
      start: () => {
        this.touched = true;
        this.spin(0);
      },
    });
    this.setMode(this.options.mode);
    this.paintBackground();
    this.applyLook();
    if (this.options.poster) writePoster(this.options.poster);
    if (page.file) this.open(page.file, page.name);
    else if (this.options.src) this.open(this.options.src, this.options.src.split(/[?#]/)[0].split('/').pop());
    else if (this.options.poster) writePoster(null);
  }

  /** @param source  of FieldLoader.load(). Resolves when it shows, or an error does. */
  async open(source, name = '') {
    if (!this.stage) return;
    const begin = performance.now();
    this.hideProblem();
    document.body.classList.remove('empty');
    if (this.source && this.source.source !== source) Object.assign(this.options, OF_FIRST_FILE);
    const own = (this.source = this.loading = { source, name });
    this.comparison.close();
    this.controls.pose = null;
    this.touched = false;
    this.stage.clear();
    this.facts = { name };
    at('title').textContent = this.titleText();
    this.arriving(0, 0);
    try {
      const on = {
        progress: (received, total) => this.arriving(received, total),
        field: (packed, info, final) => this.show(packed, info, final, begin),
      };
      const loading = this.loader.load(source, on, this.options); // sliders may move while the file arrives
      const { bytes, part } = await loading.finally(() => {
        if (this.source === own) this.loading = null;
      });
      this.facts.bytes = bytes;
      this.facts.loaded = performance.now() - begin;
      this.describe();
      this.say(`${this.titleText()} is shown.`);
      if (Object.entries(part).some(([name, value]) => this.options[name] !== value)) await this.decodeAgain();
      if (this.options.capture) await this.comparison.open(this.options.capture);
    } catch (error) {
      if (error.name !== 'AbortError') this.fail(error);
    } finally {
      if (this.source === own) at('progress').hidden = true;
    }
  }

  show(packed, info, final, begin) {
    const first = !this.stage.field || !this.controls.pose;
    this.facts.info = info;
    this.stage.setField(packed);
    this.hideProblem(); // of a decode before
    document.body.classList.remove('empty');
    this.facts.first ??= performance.now() - begin;
    this.facts.final = final;
    this.controls.up = packed.up;
    this.controls.radius = packed.radius;
    if (first || (final && !this.touched)) this.reset();
    writePoster(null);
    if (final && this.controls.smooth && this.options.autorotate) this.spin(this.options.autorotate);
    this.describe();
    document.body.dataset.state = final ? 'ready' : 'coarse';
  }

  /** Decodes the same file with other levels, groups or layers; when it is here, where it is still on its way. */
  async decodeAgain(part) {
    Object.assign(this.options, part);
    if (this.loading || !this.loader.whole) return;
    const { source } = this,
      begin = performance.now();
    this.say('Decoding …');
    try {
      const { packed, info } = await this.loader.decode(this.options);
      if (this.source !== source) return;
      if (!this.controls.pose) return this.show(packed, info, true, begin); // all of it was too much
      this.facts.info = info;
      this.stage.setField(packed);
      this.hideProblem();
      document.body.dataset.state = 'ready';
      this.describe();
      this.say('Decoded.');
    } catch (error) {
      if (error.name !== 'AbortError') this.fail(error);
    }
  }

  // Views

  startPose() {
    const { azimuth, elevation, fov, zoom, view } = this.options;
    if (view) return poseOfCamera({ ...view, rotation: view.rotation }, this.stage.field);
    const pose = fittingPose(this.stage.field, { azimuth: azimuth ?? 30, elevation: elevation ?? 20, fov });
    return { ...pose, distance: pose.distance / zoom };
  }

  reset() {
    this.comparison.leave();
    this.controls.pose = this.stage.pose = this.startPose();
    at('fov').value = Math.round(this.controls.pose.fov);
    this.moved();
  }

  fit() {
    const { azimuth, elevation, fov } = this.controls.pose;
    this.comparison.leave();
    this.controls.pose = this.stage.pose = fittingPose(this.stage.field, { azimuth, elevation, fov });
    this.moved();
  }

  moved() {
    if (this.comparison.shown) this.comparison.leave();
    this.stage.redraw({ moving: true });
  }

  /** Degrees a second; 0 stops. */
  spin(speed) {
    this.spinning = speed;
    press('spin', speed !== 0);
    this.stage?.redraw({ moving: true });
  }

  tick(seconds) {
    let moving = this.controls.tick(seconds);
    if (this.spinning && this.controls.pose && !document.hidden) {
      this.controls.pose.azimuth += this.spinning * Math.min(seconds, 0.1);
      moving = true;
    }
    return moving;
  }

  setMode(mode) {
    this.controls.mode = mode;
    document.querySelector(`input[name=mode][value=${mode}]`).checked = true;
    this.say(mode === 'fly' ? 'Fly: W A S D Q E and drag.' : 'Orbit.');
  }

  // What is said

  titleText() {
    const metadata = this.facts.info?.metadata ?? {};
    const named = (metadata.source ?? this.facts.name ?? '').replace(/\.slf$/, '').replaceAll('_', ' ');
    return this.options.title ?? metadata.title ?? named;
  }

  describe() {
    const { info, bytes, first, loaded, final } = this.facts,
      field = this.stage.field;
    const title = this.titleText();
    at('title').textContent = title;
    document.title = title ? `${title}: surface light field` : 'Surface light field';
    const size = bytes ? sizeText(bytes) : '';
    at('subtitle').textContent = [`${grouped(field.points)} points`, size, final ? '' : 'coarse, more is arriving']
      .filter(Boolean)
      .join(' · ');
    slider('levels', 1, info.bits, this.options.levels || info.bits);
    slider('groups', 1, Math.max(1, info.groups), this.options.groups || info.groups);
    at('groups-row').hidden = !(info.groups > 1);
    slider('layers', 1, Math.max(1, info.layers), this.options.layers || info.layers);
    at('layers-row').hidden = !(info.layers > 1);
    writeOutputs();
    writeFacts(this.facts, this.stage);
  }

  afterDrawing() {
    const now = performance.now();
    if (this.stage.field && !at('panel').hidden && !(now < this.factsDue)) {
      this.factsDue = now + 500; // ms
      writeFacts(this.facts, this.stage);
    }
    if (!at('compare').hidden && this.comparison.shown?.photograph) this.comparison.lay();
    document.body.dataset.frame = String(Number(document.body.dataset.frame ?? 0) + 1);
  }

  arriving(received, total) {
    writeProgress(received, total);
    const share = total ? `, ${((100 * received) / total).toFixed(0)} %` : '';
    if (!this.stage.field) at('subtitle').textContent = `Loading${share}`;
  }

  say(text) {
    at('status').textContent = text;
  }

  fail(error) {
    if (!(error instanceof ViewerError)) {
      console.error(error);
      error = new ViewerError('damaged', error.message);
    }
    this.facts.info ??= error.info;
    writeProblem(error, this.source !== undefined);
    document.body.dataset.state = `failed ${error.kind}`;
    document.body.classList.add('failed');
    if (this.stage?.field) return;
    document.body.classList.add('empty');
    if (!at('panel').hidden) this.togglePanel(); // nothing is left that it is of
  }

  hideProblem() {
    at('problem').hidden = true;
    document.body.classList.remove('failed');
    delete document.body.dataset.state;
  }

  // Looks

  applyLook() {
    const { options, stage } = this;
    at('exposure').value = options.exposure;
    at('mean').checked = options.mean;
    at('points').value = options.points;
    Object.assign(stage.look, { exposure: options.exposure, meanOnly: options.mean, share: options.points / 100 });
    writeOutputs();
  }

  paintBackground() {
    const colour = backgroundColour(this.background);
    writeTheme(this.background, colour);
    if (!this.stage) return;
    this.stage.look.background = colour;
    this.stage.redraw();
  }

  async save() {
    download(await this.stage.screenshot(), `${(this.titleText() || 'light field').replace(/[^\w.-]+/g, '_')}.png`);
  }

  togglePanel() {
    const hidden = !at('panel').hidden;
    at('panel').hidden = hidden;
    document.body.classList.toggle('open', !hidden);
    document.querySelector('[data-do=panel]').setAttribute('aria-expanded', String(!hidden));
  }

  nextBackground() {
    const names = Object.keys(BACKGROUNDS);
    this.background = names[(names.indexOf(this.background) + 1) % names.length];
    this.paintBackground();
  }

  openCoarser() {
    const most = this.facts.info?.levels ?? 9;
    this.options.levels = Math.max(1, Math.min(this.options.levels || most, most) - 2);
    this.open(this.source.source, this.source.name);
  }
}
