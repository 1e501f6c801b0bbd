// SPDX-License-Identifier: Apache-2.0
// The viewer's elements, in a document or in a shadow root, and what they say of numbers.

import { BACKGROUNDS } from './options.js';
import { ENGLISH } from './words.js';

/** Of the card that says what went wrong, by ViewerError.kind. */
const TITLES = {
  damaged: 'This file cannot be read',
  'too-large': 'This file is too large for this device',
  memory: 'Not enough memory',
  network: 'Something did not arrive',
  policy: 'This page forbids the viewer',
  'no-webgl2': 'This browser cannot draw it',
  unsupported: 'This viewer cannot decode this file',
  'no-view-maps': 'There is nothing to see in this file',
};

function element(name, text) {
  const made = document.createElement(name);
  made.textContent = text;
  return made;
}

export class Elements {
  /**
   * @param {Document|ShadowRoot} root  that has the elements of viewer.html
   * @param {HTMLElement} frame  around them: it carries the states as classes, and data-state
   * @param {import('./words.js').Words} words  of a language
   */
  constructor(root = document, frame = document.body, words = ENGLISH) {
    this.root = root;
    this.frame = frame;
    this.words = words;
    this.whole = root === document; // the page is the viewer's own
    words.translate(frame);
    if (this.whole) document.documentElement.lang = words.language;
    else frame.lang = words.language;
  }

  at(id) {
    return this.root.getElementById(id);
  }

  one(selector) {
    return this.root.querySelector(selector);
  }

  t(text) {
    return this.words.t(text);
  }

  grouped(number) {
    return this.words.grouped(number);
  }

  decimal(value, digits) {
    return this.words.decimal(value, digits);
  }

  size(bytes) {
    const [value, unit] = bytes < 1e6 ? [bytes / 1e3, 'kB'] : [bytes / 1e6, 'MB'];
    return `${this.decimal(value, value < 10 ? 2 : value < 100 ? 1 : 0)} ${unit}`;
  }

  /** Whether a button's action goes on. */
  press(action, on) {
    this.one(`[data-do=${action}]`)?.setAttribute('aria-pressed', String(on));
  }

  slider(id, low, high, value) {
    Object.assign(this.at(id), { min: low, max: high, value });
  }

  /** Beside each slider, what it stands at. */
  writeOutputs() {
    const value = (id) => Number(this.at(id).value);
    const set = (id, text) => {
      this.one(`output[for=${id}]`).textContent = this.t(text);
    };
    set('exposure', `${value('exposure') > 0 ? '+' : ''}${this.decimal(value('exposure'), 1)} stops`);
    set('points', `${value('points')} %`);
    set('levels', `${value('levels')} of ${this.at('levels').max}`);
    set('groups', `${value('groups')} of ${this.at('groups').max}`);
    set('layers', `${value('layers')} of ${this.at('layers').max}`);
    set('resolution', `${value('resolution')} %`);
    set('fov', `${value('fov')}°`);
  }

  /** The thin line on top. @param total  0: nobody knows */
  writeProgress(received, total) {
    const bar = this.at('progress'),
      share = total ? (100 * received) / total : 0;
    bar.hidden = false;
    bar.classList.toggle('unknown', !total);
    bar.firstElementChild.style.width = total ? `${share}%` : '';
    if (total) bar.setAttribute('aria-valuenow', share.toFixed(0));
    else bar.removeAttribute('aria-valuenow');
  }

  /** What is known of a file. @param facts  of a Viewer @param stage  what shows it */
  writeFacts(facts, { field, frameTime }) {
    const { info, bytes, first, loaded, frames = 1 } = facts;
    const rows = {
      Name: facts.name,
      Size: bytes && this.size(bytes),
      Points: this.grouped(field.points),
      'Bits per point': bytes ? this.decimal((8 * bytes) / (field.points * frames), 2) : '',
      Functions: info.functions,
      Components: field.components,
      Grid: `${info.bits} bits`,
      Frame: info.frame,
      Transfer: field.linear ? 'linear' : 'display',
      'Colour fetches a point': 4 * field.layers + 2,
      'Graphics memory': this.size(field.bytes),
      'First picture': first && `${this.decimal(first / 1000, 2)} s`,
      Loaded: loaded && `${this.decimal(loaded / 1000, 2)} s`,
      'Frame in motion': frameTime && `${this.decimal(frameTime, frameTime < 10 ? 1 : 0)} ms`,
      Format: info.version,
      Encoder: info.metadata?.encoder,
    };
    this.at('facts').replaceChildren(
      ...Object.entries(rows)
        .filter(([, v]) => v)
        .flatMap(([k, v]) => [element('dt', this.t(k)), element('dd', String(v))]),
    );
  }

  /** @param {ViewerError} error @param again  whether there is a file that could be opened with less in it */
  writeProblem({ kind, words, detail }, again) {
    const problem = this.at('problem'),
      said = this.t(words);
    problem.querySelector('h2').textContent = this.t(Object.hasOwn(TITLES, kind) ? TITLES[kind] : TITLES.damaged);
    problem.querySelector('p').textContent = said;
    problem.querySelector('.detail').textContent = detail;
    this.one('[data-do=coarser]').hidden = !(again && (kind === 'too-large' || kind === 'memory'));
    problem.hidden = false;
    this.at('progress').hidden = true;
  }

  /** Letters that can be read on the background. @param colour  RGB 0 .. 1; null: transparent */
  writeTheme(background, colour, darkPage) {
    const luminance = colour ? 0.3 * colour[0] + 0.6 * colour[1] + 0.1 * colour[2] : Number(!darkPage);
    const paper = Object.hasOwn(BACKGROUNDS, background) ? BACKGROUNDS[background] : colour ? background : 'transparent';
    for (const each of this.whole ? [document.documentElement, this.frame] : [this.frame]) {
      each.classList.toggle('dark', luminance < 0.55);
      each.classList.toggle('transparent', !colour);
      each.style.setProperty('--paper', paper);
    }
    for (const input of this.root.querySelectorAll('input[name=background]'))
      input.checked = input.value === background;
  }

  /** A picture that stands there until the light field does. @param address  null: it does */
  writePoster(address) {
    const poster = this.at('poster');
    if (address) {
      poster.onerror = () => {
        poster.hidden = true; // one that does not arrive is no picture, nor a sign of a broken one
      };
      poster.src = address;
      poster.hidden = false;
      poster.classList.remove('gone');
      this.frame.classList.remove('empty');
    } else if (!poster.hidden) {
      poster.classList.add('gone');
      setTimeout(() => {
        poster.hidden = true;
      }, 600);
    }
  }
}

export function download(blob, name) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
