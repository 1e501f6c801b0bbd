// SPDX-License-Identifier: Apache-2.0
// Looking through the cameras of a capture: a photograph beside the rendering, and how alike they are.
import { fetchCapture, psnrWithin } from './capture.js';
import { axesOf, dot, fittedCamera, poseOfCamera } from './view.js';

export class Comparison {
  /** @param {import('./viewer.js').Viewer} viewer */
  constructor(viewer) {
    this.viewer = viewer;
    this.page = viewer.page;
    this.cameras = [];
    this.shown = null; // of the one that is looked through: index, camera, photograph, is it wanted to be seen
  }

  async open(capture) {
    const { source } = this.viewer;
    let cameras, failure;
    try {
      cameras = typeof capture === 'string' ? await fetchCapture(capture) : capture;
    } catch (error) {
      failure = error;
    }
    if (source !== this.viewer.source) return; // another file was opened
    if (failure) return this.viewer.report.fail(failure);
    this.cameras = cameras;
    this.page.at('cameras').replaceChildren(new Option(this.page.t('Free view'), ''), ...this.cameras.map((c, i) => new Option(c.name, i)));
    this.page.at('photographs').hidden = false;
    this.page.one('[data-do=compare]').hidden = false;
    const { camera } = this.viewer.options;
    if (camera === null) return;
    const named = this.cameras.findIndex((c) => c.name === camera || c.name.split('/').pop() === camera);
    const index = named >= 0 ? named : Number(camera);
    if (index >= 0 && this.cameras[index]) await this.lookThrough(index);
  }

  async lookThrough(index) {
    const camera = this.cameras[index];
    if (!camera || !this.viewer.stage.field) return;
    this.viewer.spin(0);
    this.shown = { index, camera, photograph: null, wanted: true };
    const own = this.shown;
    this.viewer.controls.pose = poseOfCamera(camera, this.viewer.stage.field);
    this.viewer.stage.pose = this.viewer.controls.pose;
    this.viewer.stage.camera = camera;
    this.page.at('cameras').value = index;
    this.page.at('psnr').textContent = this.page.t('The photograph is on its way.');
    this.viewer.stage.redraw();
    try {
      own.photograph = await camera.photograph();
    } catch (error) {
      const { words = error.message, detail } = error;
      const said = this.page.t(words);
      if (this.shown === own) this.page.at('psnr').textContent = detail ? `${said} (${detail})` : said;
      return;
    }
    if (this.shown !== own) return;
    this.measure();
    if (own.wanted) this.show(true);
  }

  /** The camera that sees the object most as it is seen now. */
  nearest() {
    const forward = axesOf(this.viewer.controls.pose, this.viewer.controls.up)[2];
    const likeness = this.cameras.map((c) => dot(forward, c.rotation.slice(6)));
    return likeness.indexOf(Math.max(...likeness));
  }

  measure() {
    const { camera, photograph } = this.shown,
      { width, height } = camera;
    if (camera.distorted) {
      this.page.at('psnr').textContent = this.page.t('Its lens bends lines, the rendering does not: no PSNR.');
      return;
    }
    const context = new OffscreenCanvas(width, height).getContext('2d', { willReadFrequently: true });
    context.drawImage(photograph, 0, 0, width, height);
    const value = psnrWithin(
      context.getImageData(0, 0, width, height).data,
      this.viewer.stage.readCamera(camera),
      width,
      height,
    );
    this.viewer.facts.psnr = value;
    this.page.at('psnr').textContent = Number.isNaN(value)
      ? this.page.t('The object is not in this picture.')
      : this.page.t(`PSNR within the object: ${this.page.decimal(value, 2)} dB`);
  }

  show(shown) {
    if (shown && !this.shown) return this.lookThrough(this.nearest());
    if (this.shown) this.shown.wanted = shown;
    if (shown && !this.shown.photograph) return; // it shows when it comes
    this.page.at('compare').hidden = !shown;
    this.page.press('compare', shown);
    if (shown) this.lay();
    else if (this.viewer.stage) this.viewer.stage.redraw();
  }

  /** Where the camera's picture is on the stage. */
  lay() {
    const canvas = this.page.at('photograph'),
      [width, height] = this.viewer.stage.pixels();
    canvas.width = width;
    canvas.height = height;
    const [x, y, w, h] = fittedCamera(this.shown.camera, width, height).frame;
    canvas.getContext('2d').drawImage(this.shown.photograph, x, y, w, h);
    this.page.at('compare').style.setProperty('--at', `${this.page.at('divider').value}%`);
  }

  /** The cameras are those of a file that goes. */
  close() {
    this.leave();
    this.cameras = [];
    this.page.at('photographs').hidden = true;
    this.page.one('[data-do=compare]').hidden = true;
  }

  leave() {
    this.shown = null;
    if (this.viewer.stage) this.viewer.stage.camera = null;
    this.page.at('compare').hidden = true;
    this.page.at('cameras').value = '';
    this.page.at('psnr').textContent = '';
    this.page.press('compare', false);
  }

  step(by) {
    if (!this.cameras.length) return;
    const from = this.shown?.index ?? (by > 0 ? -1 : 0);
    this.lookThrough((from + by + this.cameras.length) % this.cameras.length);
  }
}
