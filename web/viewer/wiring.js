// Buttons, keys, sliders and files of the page to what the viewer does.
import { droppedCapture } from './capture.js';
import { at, press, writeOutputs } from './elements.js';

const KEYS = {
  r: 'reset',
  f: 'fit',
  ' ': 'spin',
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
};

export class Wiring {
  /** @param {import('./viewer.js').Viewer} viewer */
  constructor(viewer) {
    this.viewer = viewer;
    this.listen();
  }

  listen() {
    document.addEventListener('click', (event) => {
      const button = event.target.closest?.('[data-do]');
      if (button) this.act(button.dataset.do);
    });
    document.addEventListener('keydown', (event) => this.shortcut(event));
    at('stage').addEventListener('dblclick', () => this.viewer.stage?.field && this.viewer.fit());
    at('file').addEventListener('change', (event) => {
      this.take([...event.target.files]);
      event.target.value = '';
    });
    this.listenToDrops();
    this.listenToPanel();
    document.addEventListener('fullscreenchange', () => press('full', Boolean(document.fullscreenElement)));
  }

  act(action) {
    const field = this.viewer.stage?.field;
    const actions = {
      open: () => at('file').click(),
      reset: () => field && (this.viewer.spin(0), this.viewer.reset()),
      fit: () => field && this.viewer.fit(),
      spin: () => field && this.viewer.spin(this.viewer.spinning ? 0 : this.viewer.options.autorotate || 12),
      compare: () => this.viewer.comparison.cameras.length && this.viewer.comparison.show(at('compare').hidden),
      panel: () => this.viewer.togglePanel(),
      full: () =>
        document.fullscreenElement ? document.exitFullscreen() : document.documentElement.requestFullscreen?.(),
      help: () => (at('help').open ? at('help').close() : at('help').showModal()),
      shot: () => field && this.viewer.save(),
      mean: () => {
        at('mean').checked = !at('mean').checked;
        at('mean').dispatchEvent(new Event('input', { bubbles: true }));
      },
      mode: () => this.viewer.setMode(this.viewer.controls.mode === 'fly' ? 'orbit' : 'fly'),
      background: () => this.viewer.nextBackground(),
      before: () => this.viewer.comparison.step(-1),
      after: () => this.viewer.comparison.step(1),
      dismiss: () => {
        this.viewer.hideProblem();
        if (field) document.body.dataset.state = 'ready';
        at('stage').focus();
      },
      coarser: () => this.viewer.openCoarser(),
    };
    actions[action]?.();
  }

  shortcut(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || this.viewer.options.embed) return;
    if (event.target.matches?.('input, select, dialog *') && event.key !== 'h') return;
    if (event.key === ' ' && event.target.matches?.('button')) return;
    if (event.key === 'Escape' && !at('panel').hidden) return this.viewer.togglePanel();
    const flying = this.viewer.controls?.mode === 'fly' && /^[wasdqe]$/i.test(event.key);
    const action = KEYS[event.key.toLowerCase()];
    if (!action || flying) return;
    event.preventDefault();
    this.act(action);
  }

  listenToDrops() {
    const dragging = (on) => document.body.classList.toggle('dragging', on);
    document.addEventListener('dragover', (event) => {
      event.preventDefault();
      dragging(true);
    });
    document.addEventListener('dragleave', (event) => {
      if (!event.relatedTarget) dragging(false);
    });
    document.addEventListener('drop', (event) => {
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
      this.viewer.fail(error);
    }
  }

  listenToPanel() {
    const on = (id, type, handler) =>
      at(id).addEventListener(type, () => {
        handler(at(id));
        writeOutputs();
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
    on('divider', 'input', (e) => at('compare').style.setProperty('--at', `${e.value}%`));
    at('backgrounds').addEventListener('change', (event) => {
      this.viewer.background = event.target.value;
      this.viewer.paintBackground();
    });
    for (const input of document.querySelectorAll('input[name=mode]'))
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
