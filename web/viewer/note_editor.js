// SPDX-License-Identifier: Apache-2.0
// Writes notes: a click places a point with text, views become a tour, and the JSON of docs/notes.md is saved as a file.
// viewer.html?edit=1 fetches it. What is being written is shown at once: it stands in the guide, which checks it.
import { EDITOR_WORDS } from './note_editor_words.js';
import { readNotes } from './notes.js';
import { placeAt } from './pick.js';
import { viewParameters } from './view_link.js';

const STYLE = `.note-editor { position: absolute; right: var(--edge); top: 1.4rem; z-index: 3; width: min(19rem, calc(100% - 3rem)); display: grid; gap: 0.5rem;
  padding: 0.9rem 1.1rem; background: var(--sheet); border: 1px solid var(--line); border-radius: 0.75rem; }
.note-editor h2 { font: 400 1.1rem/1.25 var(--serif); }
.note-editor label { display: grid; gap: 0.15rem; font-size: 0.8125rem; }
.note-editor label.tick { display: flex; align-items: center; gap: 0.5rem; }
.note-editor input:not([type=checkbox]), .note-editor textarea { font: inherit; color: inherit; background: none;
  border: 1px solid var(--line); border-radius: 0.4rem; padding: 0.35rem; }
.note-editor [hidden] { display: none; }
.note-editor [aria-pressed=true] { background: var(--accent); color: var(--paper); }`;

/** Parts of the form, in their order: name, tag, text, attributes. */
const FORM = [
  ['place', 'button', 'Place a note', { type: 'button', 'aria-pressed': 'false' }],
  ['title', 'input', 'Title', { maxLength: 200 }],
  ['text', 'textarea', 'Text', { maxLength: 4000, rows: 3 }],
  ['turn', 'input', 'Turn to this view', { type: 'checkbox' }],
  ['remove', 'button', 'Delete', { type: 'button' }],
  ['stop', 'button', 'Add this view to the tour', { type: 'button' }],
  ['empty', 'button', 'Empty the tour', { type: 'button' }],
  ['save', 'button', 'Save', { type: 'button', className: 'main' }],
];
const STILL = 4; // pixels that a click may move
const OF_A_NOTE = ['title', 'text', 'turn', 'remove'];

export class NoteEditor {
  /** @param {import('./viewer.js').Viewer} viewer */
  constructor(viewer) {
    this.viewer = viewer;
    this.words = EDITOR_WORDS[viewer.page.words.language] ?? {};
    this.form = this.built();
    viewer.page.frame.append(this.form);
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(STYLE);
    document.adoptedStyleSheets = [...document.adoptedStyleSheets, sheet];
    const act = (name, on) => this.parts[name].addEventListener(on, () => this[name]());
    for (const [name, tag] of FORM) act(name, tag === 'button' ? 'click' : 'input');
    this.form.addEventListener('submit', (event) => event.preventDefault());
    this.form.addEventListener('keydown', (event) => event.stopPropagation()); // letters are no shortcuts here
    const stage = viewer.page.at('stage');
    stage.addEventListener('pointerdown', ({ clientX, clientY }) => (this.pressed = [clientX, clientY]));
    stage.addEventListener('click', (event) => this.clicked(event));
    viewer.page.at('marks').addEventListener('click', () => this.fill());
    this.fill();
  }

  built() {
    const form = document.createElement('form'),
      heading = document.createElement('h2');
    form.className = 'note-editor';
    heading.textContent = this.t('Notes');
    form.setAttribute('aria-label', heading.textContent);
    form.append(heading);
    this.parts = {};
    for (const [name, tag, text, { 'aria-pressed': pressed, ...rest }] of FORM) {
      const part = (this.parts[name] = Object.assign(document.createElement(tag), rest));
      part.name = name;
      if (pressed) part.setAttribute('aria-pressed', pressed);
      if (tag === 'button') {
        part.textContent = this.t(text);
        form.append(part);
        continue;
      }
      const label = document.createElement('label');
      label.className = rest.type === 'checkbox' ? 'tick' : '';
      label.append(...(rest.type === 'checkbox' ? [part, this.t(text)] : [this.t(text), part]));
      form.append(label);
    }
    return form;
  }

  t(text) {
    return Object.hasOwn(this.words, text) ? this.words[text] : text;
  }

  /** What is shown, as the JSON has it: members that are as a reader takes them anyway are left out. */
  get root() {
    const { annotations, tracks } = this.viewer.guide.notes;
    const given = (from) => Object.fromEntries(Object.entries(from).filter(([, value]) => value !== null && value !== '' && value !== false));
    return {
      version: 1, annotations: annotations.map((each) => ({ ...given(each), title: each.title })),
      tracks: tracks.map((track) => ({ ...given(track), stops: track.stops.map(given) })),
    };
  }

  get selected() {
    return this.viewer.guide.notes.annotations[this.viewer.guide.shown];
  }

  /** Changes the notes, shows them, and opens the card of one. */
  async change(edit, shown = this.viewer.guide.shown) {
    const root = this.root;
    edit(root);
    let notes;
    try {
      notes = readNotes(root);
    } catch (error) {
      return this.viewer.report.hint(error.words ?? error.message);
    }
    await this.viewer.guide.take(() => notes);
    if (root.annotations[shown]) this.viewer.guide.show(shown, false);
    this.fill();
  }

  /** The form, with what is selected. */
  fill() {
    const note = this.selected;
    for (const name of OF_A_NOTE) (this.parts[name].closest('label') ?? this.parts[name]).hidden = !note;
    this.parts.empty.hidden = this.viewer.guide.notes.tracks.length === 0;
    if (!note) return;
    if (this.form.getRootNode().activeElement !== this.parts.title) this.parts.title.value = note.title;
    if (this.form.getRootNode().activeElement !== this.parts.text) this.parts.text.value = note.text;
    this.parts.turn.checked = note.view !== null;
  }

  /** The view that shows, as notes have it. */
  view() {
    const { azimuth, elevation, fov, zoom, target } = viewParameters(this.viewer);
    const within = Math.min(50, Math.max(0.05, Number(zoom))); // of notes
    return { azimuth: Number(azimuth), elevation: Number(elevation), fov: Number(fov), zoom: within, target: target.split(',').map(Number) };
  }

  place() {
    const on = this.parts.place.getAttribute('aria-pressed') !== 'true';
    this.parts.place.setAttribute('aria-pressed', String(on));
    if (on) this.viewer.report.hint(this.t('Click on the object'));
  }

  clicked({ offsetX, offsetY, clientX, clientY }) {
    if (this.parts.place.getAttribute('aria-pressed') !== 'true' || !this.viewer.controls.pose) return;
    if (this.pressed && Math.hypot(clientX - this.pressed[0], clientY - this.pressed[1]) > STILL) return; // the end of a turn
    const place = placeAt(this.viewer.stage, offsetX, offsetY);
    if (!place) return this.viewer.report.hint(this.t('There is nothing here.'));
    this.parts.place.setAttribute('aria-pressed', 'false');
    const at = place.map((x) => Number(x.toPrecision(7)));
    const last = this.viewer.guide.notes.annotations.length;
    this.change((root) => root.annotations.push({ at, title: this.t('New note'), view: this.view() }), last).then(() => this.parts.title.select());
  }

  title() {
    this.change((root) => (root.annotations[this.viewer.guide.shown].title = this.parts.title.value));
  }

  text() {
    this.change((root) => (root.annotations[this.viewer.guide.shown].text = this.parts.text.value));
  }

  turn() {
    this.change((root) => (root.annotations[this.viewer.guide.shown].view = this.parts.turn.checked ? this.view() : undefined));
  }

  /** Stops of tours that show later annotations go on showing them. */
  remove() {
    const gone = this.viewer.guide.shown;
    this.viewer.guide.hide();
    this.viewer.guide.shown = undefined;
    this.change((root) => {
      root.annotations.splice(gone, 1);
      for (const { stops } of root.tracks)
        for (const stop of stops)
          if (stop.annotation === gone) delete stop.annotation;
          else if (stop.annotation > gone) --stop.annotation;
    }, -1);
  }

  /** At the end of the first tour; with the card that is open. */
  stop() {
    const open = !this.viewer.page.at('note').hidden;
    this.change((root) => {
      if (root.tracks.length === 0) root.tracks.push({ name: this.t('Notes'), stops: [] });
      root.tracks[0].stops.push({ view: this.view(), ...(open && this.selected ? { annotation: this.viewer.guide.shown } : {}) });
    });
  }

  empty() {
    this.change((root) => (root.tracks = []));
  }

  save() {
    const link = document.createElement('a'),
      name = (this.viewer.facts?.name || 'notes').replace(/\.[^.]*$/, '');
    link.href = URL.createObjectURL(new Blob([JSON.stringify(this.root, null, 2) + '\n'], { type: 'application/json' }));
    link.download = `${name}.json`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  }
}
