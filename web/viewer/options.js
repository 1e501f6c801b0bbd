// SPDX-License-Identifier: Apache-2.0
// What an address, or a page that was made by `slf html`, asks of the viewer. The list is that of
// README.md.
import { memoryOfDevice } from './device.js';

export const BACKGROUNDS = {
  paper: '#f3f1ec',
  white: '#ffffff',
  grey: '#808080',
  slate: '#191a1d',
  black: '#000000',
};

/** What is said of the first file and of no other that is opened after it. */
export const OF_FIRST_FILE = { title: null, poster: null, notes: null, metres: 0, capture: null, camera: null, view: null };

const isBlank = (given) => given === null || String(given).trim() === '';

/** @param {URLSearchParams} query  @param {object} page  the defaults of a page */
export function readOptions(query, page = {}) {
  const text = (name) => query.get(name) ?? (Object.hasOwn(page, name) ? page[name] : null) ?? null;
  const number = (name, low, high, fallback) => {
    const given = text(name),
      value = isBlank(given) ? NaN : Number(given);
    return Number.isFinite(value) ? Math.min(high, Math.max(low, value)) : fallback;
  };
  const flag = (name) => {
    const given = text(name);
    return given !== null && given !== false && !['0', 'false', 'no'].includes(String(given));
  };
  return {
    src: text('src'),
    capture: text('capture'),
    title: text('title'),
    poster: text('poster'),
    notes: text('notes'),
    metres: number('metres', 0, 1e12, 0),
    scale: text('scale') === null || flag('scale'),
    embed: flag('embed'),
    background: backgroundOf(text('background')),
    exposure: number('exposure', -3, 3, 0),
    mean: flag('mean'),
    autorotate: !flag('autorotate') ? 0 : ['', 'true', 'yes'].includes(String(text('autorotate')).trim()) ? 12 : number('autorotate', -90, 90, 0),
    azimuth: number('azimuth', -360, 360, null),
    elevation: number('elevation', -90, 90, null),
    fov: number('fov', 1, 170, 30),
    zoom: number('zoom', 0.05, 50, 1),
    camera: text('camera'),
    view: query.get('azimuth') === null ? (page.view ?? null) : null, // the address comes first
    points: number('points', 1, 100, 100),
    levels: Math.round(number('levels', 0, 21, 0)),
    groups: Math.round(number('groups', 0, 4096, 0)),
    layers: Math.round(number('layers', 0, 4, 0)),
    target: triple(text('target')),
    scroll: ['polite', 'own'].includes(text('scroll')) ? text('scroll') : flag('embed') ? 'polite' : 'own',
    loop: text('loop') === null || flag('loop'),
    paused: flag('paused'),
    speed: number('speed', 1 / 16, 16, 1),
    lang: text('lang'),
    mode: text('mode') === 'fly' ? 'fly' : 'orbit',
    memory: Math.floor(number('memory', 16, 3500, memoryOfDevice()) * 2 ** 20),
  };
}

/** "x,y,z" or three numbers; null where it is neither. */
function triple(given) {
  const numbers = (Array.isArray(given) ? given : String(given ?? '').split(',')).map((v) => (isBlank(v) ? NaN : Number(v)));
  return numbers.length === 3 && numbers.every(Number.isFinite) ? numbers : null;
}

/** Name of BACKGROUNDS, "transparent", or RRGGBB with or without #; null where it is none of them. */
export function backgroundOf(given) {
  if (given === null) return null;
  if (Object.hasOwn(BACKGROUNDS, given) || given === 'transparent') return given;
  const hex = /^#?([0-9a-f]{6})$/i.exec(given);
  return hex ? `#${hex[1].toLowerCase()}` : null;
}

/** @returns {number[]|null} RGB 0 .. 1 of backgroundOf(); null: transparent */
export function backgroundColour(name) {
  if (name === 'transparent') return null;
  const hex = Object.hasOwn(BACKGROUNDS, name) ? BACKGROUNDS[name] : name;
  return [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255);
}
