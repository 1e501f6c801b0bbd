// SPDX-License-Identifier: Apache-2.0
// What a viewer says: of the file that is shown, on its way, or cannot be.
import { ViewerError } from './packed_field.js';

const HINT = 1600; // ms

export class Report {
  /** @param {import('./viewer.js').Viewer} viewer */
  constructor(viewer) {
    this.viewer = viewer;
    this.page = viewer.page;
  }

  titleText() {
    const metadata = this.viewer.facts.info?.metadata ?? {};
    const named = (metadata.source ?? this.viewer.facts.name ?? '').replace(/\.slf$/, '').replaceAll('_', ' ');
    return this.viewer.options.title ?? metadata.title ?? named;
  }

  describe() {
    const { info, bytes, final, frames, coarser } = this.viewer.facts,
      { field } = this.viewer.stage;
    const title = this.titleText(),
      t = (text) => this.page.t(text);
    this.page.at('title').textContent = title;
    if (this.page.whole) document.title = title ? `${title}: ${t('surface light field')}` : t('Surface light field');
    const shown = coarser ?? this.viewer.options,
      fewer = (what) => coarser && coarser[what] !== this.viewer.options[what] && coarser[what] < info[what];
    const size = bytes ? this.page.size(bytes) : '';
    const said = [
      t(`${this.page.grouped(field.points)} points`),
      frames > 1 && t(`${this.page.grouped(frames)} frames`),
      size,
      !final && t('coarse, more is arriving'),
      fewer('levels') && t(`coarser, for want of memory: ${coarser.levels} of ${info.levels} levels`),
      fewer('groups') && t(`fewer functions, for want of memory: ${coarser.groups} of ${info.groups} groups`),
    ];
    this.page.at('subtitle').textContent = said.filter(Boolean).join(' · ');
    this.page.one('#caption [data-do=all]').hidden = !coarser;
    this.page.slider('levels', 1, info.bits, shown.levels || info.bits);
    this.page.slider('groups', 1, Math.max(1, info.groups), shown.groups || info.groups);
    this.page.at('groups-row').hidden = !(info.groups > 1);
    this.page.slider('layers', 1, Math.max(1, info.layers), this.viewer.options.layers || info.layers);
    this.page.at('layers-row').hidden = !(info.layers > 1);
    this.page.writeOutputs();
    this.page.writeFacts(this.viewer.facts, this.viewer.stage);
  }

  afterDrawing() {
    const now = performance.now();
    if (this.viewer.stage.field && !this.page.at('panel').hidden && !(now < this.viewer.factsDue)) {
      this.viewer.factsDue = now + 500; // ms
      this.page.writeFacts(this.viewer.facts, this.viewer.stage);
    }
    this.viewer.guide?.lay();
    this.viewer.ruler?.lay();
    if (!this.page.at('compare').hidden && this.viewer.comparison.shown?.photograph) this.viewer.comparison.lay();
    this.page.frame.dataset.frame = String(Number(this.page.frame.dataset.frame ?? 0) + 1);
  }

  arriving(received, total) {
    this.page.writeProgress(received, total);
    const share = total ? `, ${((100 * received) / total).toFixed(0)} %` : '';
    if (!this.viewer.stage.field) this.page.at('subtitle').textContent = this.page.t(`Loading${share}`);
    this.viewer.emit('progress', { received, total });
  }

  say(text) {
    this.page.at('status').textContent = this.page.t(text);
  }

  fail(error) {
    if (!(error instanceof ViewerError)) {
      console.error(error);
      error = new ViewerError('damaged', error.message);
    }
    this.viewer.facts.info ??= error.info;
    this.page.writeProblem(error, this.viewer.source !== undefined);
    const { loader, options } = this.viewer;
    this.page.one('#problem [data-do=all]').hidden = !(error.kind === 'too-large' && loader.whole && !options.all);
    this.page.frame.dataset.state = `failed ${error.kind}`;
    this.viewer.emit('error', error);
    this.page.frame.classList.add('failed');
    if (this.viewer.stage?.field) return;
    this.page.frame.classList.add('empty');
    if (!this.page.at('panel').hidden) this.viewer.togglePanel(); // nothing is left that it is of
  }

  hideProblem() {
    this.page.at('problem').hidden = true;
    this.page.frame.classList.remove('failed');
    delete this.page.frame.dataset.state;
  }

  /** A line over the stage for a moment. */
  hint(text) {
    const hint = this.page.at('hint');
    hint.textContent = this.page.t(text);
    hint.classList.add('shown');
    clearTimeout(this.hinting);
    this.hinting = setTimeout(() => hint.classList.remove('shown'), HINT);
  }
}
