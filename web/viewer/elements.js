// The page's elements, and what they say of numbers.

import { BACKGROUNDS } from './options.js';

export const at = (id) => document.getElementById(id);
export const grouped = new Intl.NumberFormat('en').format;

/** Of the card that says what went wrong, by ViewerError.kind. */
const TITLES = {
  damaged: 'This file cannot be read',
  'too-large': 'This file is too large for this device',
  memory: 'Not enough memory',
  network: 'Something did not arrive',
  'no-webgl2': 'This browser cannot draw it',
  unsupported: 'This viewer cannot decode this file',
  'no-view-maps': 'There is nothing to see in this file',
};

/** Whether a button's action goes on. */
export function press(action, on) {
  document.querySelector(`[data-do=${action}]`)?.setAttribute('aria-pressed', String(on));
}

export function slider(id, low, high, value) {
  Object.assign(at(id), { min: low, max: high, value });
}

function element(name, text) {
  const made = document.createElement(name);
  made.textContent = text;
  return made;
}

export function sizeText(bytes) {
  const [value, unit] = bytes < 1e6 ? [bytes / 1e3, 'kB'] : [bytes / 1e6, 'MB'];
  return `${value.toFixed(value < 10 ? 2 : value < 100 ? 1 : 0)} ${unit}`;
}

/** Beside each slider, what it stands at. */
export function writeOutputs() {
  const value = (id) => Number(at(id).value);
  const set = (id, text) => {
    document.querySelector(`output[for=${id}]`).textContent = text;
  };
  set('exposure', `${value('exposure') > 0 ? '+' : ''}${value('exposure').toFixed(1)} stops`);
  set('points', `${value('points')} %`);
  set('levels', `${value('levels')} of ${at('levels').max}`);
  set('groups', `${value('groups')} of ${at('groups').max}`);
  set('layers', `${value('layers')} of ${at('layers').max}`);
  set('resolution', `${value('resolution')} %`);
  set('fov', `${value('fov')}°`);
}

/** The thin line on top. @param total  0: nobody knows */
export function writeProgress(received, total) {
  const bar = at('progress'),
    share = total ? (100 * received) / total : 0;
  bar.hidden = false;
  bar.classList.toggle('unknown', !total);
  bar.firstElementChild.style.width = total ? `${share}%` : '';
  if (total) bar.setAttribute('aria-valuenow', share.toFixed(0));
  else bar.removeAttribute('aria-valuenow');
}

/** What is known of a file. @param facts  of a Viewer @param stage  what shows it */
export function writeFacts(facts, { field, frameTime }) {
  const { info, bytes, first, loaded } = facts;
  const rows = {
    Name: facts.name,
    Size: bytes && sizeText(bytes),
    Points: grouped(field.points),
    'Bits per point': bytes ? ((8 * bytes) / field.points).toFixed(2) : '',
    Functions: info.functions,
    Components: field.components,
    Grid: `${info.bits} bits`,
    Frame: info.frame,
    Transfer: field.linear ? 'linear' : 'display',
    'Colour fetches a point': 4 * field.layers + 2,
    'Graphics memory': sizeText(field.bytes),
    'First picture': first && `${(first / 1000).toFixed(2)} s`,
    Loaded: loaded && `${(loaded / 1000).toFixed(2)} s`,
    'Frame in motion': frameTime && `${frameTime.toFixed(frameTime < 10 ? 1 : 0)} ms`,
    Format: info.version,
    Encoder: info.metadata?.encoder,
  };
  at('facts').replaceChildren(
    ...Object.entries(rows)
      .filter(([, v]) => v)
      .flatMap(([k, v]) => [element('dt', k), element('dd', String(v))]),
  );
}

/** @param {ViewerError} error @param again  whether there is a file that could be opened with less in it */
export function writeProblem({ kind, words, detail }, again) {
  const problem = at('problem');
  problem.querySelector('h2').textContent = TITLES[kind] ?? TITLES.damaged;
  problem.querySelector('p').textContent = words;
  problem.querySelector('.detail').textContent = detail;
  document.querySelector('[data-do=coarser]').hidden = !(again && (kind === 'too-large' || kind === 'memory'));
  problem.hidden = false;
  at('progress').hidden = true;
}

/** Letters that can be read on the background. @param colour  RGB 0 .. 1; null: transparent */
export function writeTheme(background, colour) {
  const root = document.documentElement;
  const luminance = colour ? 0.3 * colour[0] + 0.6 * colour[1] + 0.1 * colour[2] : 1;
  root.classList.toggle('dark', luminance < 0.55);
  root.classList.toggle('transparent', !colour);
  root.style.setProperty('--paper', BACKGROUNDS[background] ?? (colour ? background : 'transparent'));
  for (const input of document.querySelectorAll('input[name=background]')) input.checked = input.value === background;
}

/** A picture that stands there until the light field does. @param address  null: it does */
export function writePoster(address) {
  const poster = at('poster');
  if (address) {
    poster.src = address;
    poster.hidden = false;
    document.body.classList.remove('empty');
  } else if (!poster.hidden) {
    poster.classList.add('gone');
    setTimeout(() => {
      poster.hidden = true;
    }, 600);
  }
}

export function download(blob, name) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
