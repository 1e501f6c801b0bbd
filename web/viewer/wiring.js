// SPDX-License-Identifier: Apache-2.0
// Buttons, keys, sliders and files of the page to what the viewer does.
import { droppedCapture } from './capture.js';
import { copyEmbedding, copyLink } from './view_link.js';

const KEYS = {
  r: 'reset',
  f: 'fit',
  ' ': 'go',
  c: 'compare',
  g: 'panel',
  l: 'full',
  h: 'help',
  '?': 'help',
  p: 'shot',
  o: 'open',
  m: 'mean',
  v: 'mode',
  b: 'background',
  '[': 'before',
  ']': 'after',
  n: 'note',
  t: 'tour',
  x: 'measure',
  ',': 'earlier',
  '.': 'later',
};

export class Wiring {
  /** @param {import('./viewer.js').Viewer} viewer */
  constructor(viewer) {
    this.viewer = viewer;
    this.page = viewer.page;
    this.end = new AbortController();
    this.listen();
  }

  /** Listens on the root, which outlives a viewer: until dispose(). */
  onRoot(type, handler) {
    this.page.root.addEventListener(type, handler, { signal: this.end.signal });
  }

  dispose() {
    this.end.abort();
    this.around?.disconnect();
  }

  listen() {
    this.onRoot('click', (event) => {
      const button = event.target.closest?.('[data-do]');
      if (button) this.act(button.dataset.do);
    });
    this.onRoot('keydown', (event) => this.shortcut(event));
    this.page.at('stage').addEventListener('dblclick', () => this.viewer.stage?.field && this.viewer.fit());
    this.page.at('file').addEventListener('change', (event) => {
      this.take([...event.target.files]);
      event.target.value = '';
    });
    this.listenToDrops();
    this.listenToPanel();
    this.onRoot('fullscreenchange', () => this.full(Boolean(this.page.root.fullscreenElement)));
    this.page.at('tools').addEventListener('beforexrselect', (event) => event.preventDefault()); // a button places nothing
    this.followPage();
    if (!this.viewer.link) this.page.one('[data-do=link]').hidden = true;
    if (!this.page.whole || !/^http/.test(location.protocol)) this.page.one('[data-do=snippet]').hidden = true;
  }

  /** Dark or light, by the reader's device and by what a page says of itself. */
  followPage() {
    const follow = () => this.viewer.followPage();
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', follow, { signal: this.end.signal });
    if (this.page.whole) return;
    this.around = new MutationObserver(follow);
    for (const each of [document.documentElement, document.body, this.page.root.host])
      this.around.observe(each, { attributes: true, attributeFilter: ['class', 'style', 'data-theme'] });
  }

  /** Nothing scrolls beside a viewer that has the screen. */
  full(full) {
    this.page.press('full', full);
    this.viewer.controls?.setPolite(!full && this.viewer.options.scroll === 'polite');
  }

  act(action) {
    const field = this.viewer.stage?.field;
    const actions = {
      open: () => this.page.at('file').click(),
      reset: () => field && (this.viewer.spin(0), this.viewer.reset()),
      fit: () => field && this.viewer.fit(),
      spin: () => field && this.viewer.spin(this.viewer.spinning ? 0 : this.viewer.options.autorotate || 12),
      go: () => (this.viewer.playback.moves ? this.viewer.playback.toggle() : actions.spin()),
      playback: () => this.viewer.playback.toggle(),
      earlier: () => this.viewer.playback.step(-1),
      later: () => this.viewer.playback.step(1),
      loop: () => this.viewer.playback.setLoop(!this.viewer.options.loop),
      compare: () => this.viewer.comparison.cameras.length && this.viewer.comparison.show(this.page.at('compare').hidden),
      panel: () => this.viewer.togglePanel(),
      full: () =>
        this.page.root.fullscreenElement ? document.exitFullscreen() : this.viewer.screen.requestFullscreen?.(),
      help: () => (this.page.at('help').open ? this.page.at('help').close() : this.page.at('help').showModal()),
      shot: () => field && this.viewer.save(),
      note: () => field && this.viewer.guide.next(),
      'note-close': () => this.viewer.guide.hide(),
      tour: () => field && this.viewer.guide.play(),
      measure: () => field && this.viewer.ruler.toggle(),
      vr: () => field && this.viewer.rooms.toggle('vr'),
      ar: () => field && this.viewer.rooms.toggle('ar'),
      link: () => field && copyLink(this.viewer),
      snippet: () => field && copyEmbedding(this.viewer),
      mean: () => {
        this.page.at('mean').checked = !this.page.at('mean').checked;
        this.page.at('mean').dispatchEvent(new Event('input', { bubbles: true }));
      },
      mode: () => field && this.viewer.setMode(this.viewer.controls.mode === 'fly' ? 'orbit' : 'fly'),
      background: () => this.viewer.nextBackground(),
      before: () => this.viewer.comparison.step(-1),
      after: () => this.viewer.comparison.step(1),
      dismiss: () => {
        this.viewer.report.hideProblem();
        if (field) this.page.frame.dataset.state = 'ready';
        this.page.at('stage').focus();
      },
      all: () => this.viewer.openAll(),
      coarser: () => this.viewer.openCoarser(),
    };
    if (Object.hasOwn(actions, action)) actions[action]();
  }

  shortcut(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || this.viewer.options.embed) return;
    if (event.target.matches?.('input, select, dialog *') && event.key !== 'h') return;
    if (event.key === ' ' && event.target.matches?.('button')) return;
    if (event.key === 'Escape' && !this.page.at('note').hidden) return this.viewer.guide.hide();
    if (event.key === 'Escape' && this.viewer.ruler.on) return this.viewer.ruler.toggle(false);
    if (event.key === 'Escape' && !this.page.at('panel').hidden) return this.viewer.togglePanel();
    const flying = this.viewer.controls?.mode === 'fly' && /^[wasdqe]$/i.test(event.key);
    const key = event.key.toLowerCase(),
      action = Object.hasOwn(KEYS, key) && KEYS[key];
    if (!action || flying) return;
    event.preventDefault();
    this.act(action);
  }

  listenToDrops() { // what is dropped on a viewer is for that one
    const dragging = (on) => this.page.frame.classList.toggle('dragging', on);
    this.onRoot('dragover', (event) => {
      event.preventDefault();
      dragging(true);
    });
    this.onRoot('dragleave', (event) => {
      if (!this.page.frame.contains(event.relatedTarget)) dragging(false);
    });
    this.onRoot('drop', (event) => {
      event.preventDefault();
      dragging(false);
      droppedFiles(event.dataTransfer).then((files) => this.take(files));
    });
  }

  /** A file, or cameras and photographs beside it. */
  async take(files) {
    const file =
      files.find((each) => each.name.endsWith('.slf')) ??
      (files.length === 1 && !/\.json$/.test(files[0].name) ? files[0] : null);
    const opening = file && this.viewer.open(file, file.name);
    const { source } = this.viewer;
    await opening;
    try {
      const capture = files.length > 0 && (await droppedCapture(files));
      if (source !== this.viewer.source) return; // another file was opened: the capture is not of that
      if (capture) await this.viewer.comparison.open(capture);
    } catch (error) {
      this.viewer.report.fail(error);
    }
  }

  listenToPanel() {
    const on = (id, type, handler) =>
      this.page.at(id).addEventListener(type, () => {
        handler(this.page.at(id));
        this.page.writeOutputs();
      });
    const look = (change) => {
      if (this.viewer.stage) {
        Object.assign(this.viewer.stage.look, change);
        this.viewer.stage.redraw();
      }
    };
    on('exposure', 'input', (e) => look({ exposure: Number(e.value) }));
    on('mean', 'input', (e) => look({ meanOnly: e.checked }));
    on('points', 'input', (e) => look({ share: Number(e.value) / 100 }));
    on('resolution', 'input', (e) => look({ resolution: Number(e.value) / 100 }));
    on('levels', 'input', () => {});
    on('levels', 'change', (e) => this.viewer.decodeAgain({ levels: e.value === e.max ? 0 : Number(e.value) }));
    on('groups', 'input', () => {});
    on('groups', 'change', (e) => this.viewer.decodeAgain({ groups: e.value === e.max ? 0 : Number(e.value) }));
    on('layers', 'input', () => {});
    on('layers', 'change', (e) => this.viewer.decodeAgain({ layers: e.value === e.max ? 0 : Number(e.value) }));
    on('fov', 'input', (e) => this.viewer.controls.setFov(Number(e.value)));
    on('cameras', 'change', (e) =>
      e.value === '' ? this.viewer.reset() : this.viewer.comparison.lookThrough(Number(e.value)),
    );
    on('divider', 'input', (e) => this.page.at('compare').style.setProperty('--at', `${e.value}%`));
    this.page.at('backgrounds').addEventListener('change', (event) => {
      this.viewer.chosen = this.viewer.background = event.target.value;
      this.viewer.paintBackground();
    });
    for (const input of this.page.root.querySelectorAll('input[name=mode]'))
      input.addEventListener('change', () => this.viewer.setMode(input.value));
  }
}

/** Files and those of folders that were dropped. */
async function droppedFiles(transfer) {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.()).filter(Boolean);
  if (!entries.length) return [...transfer.files];
  const files = [];
  const visit = async (entry) => {
    if (entry.isFile) return files.push(await new Promise((resolve, reject) => entry.file(resolve, reject)));
    const reader = entry.createReader();
    for (;;) {
      const some = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
      if (!some.length) return;
      for (const each of some) await visit(each);
    }
  };
  for (const entry of entries) await visit(entry);
  return files;
}
