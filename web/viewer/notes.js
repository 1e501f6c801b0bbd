// SPDX-License-Identifier: Apache-2.0
// What a file's owner says about it: points with text, and tracks of views, in a small JSON (docs/notes.md). Everything in
// it is checked before any of it is used; texts are texts, never markup.
import { ViewerError } from './packed_field.js';

const MOST = { annotations: 200, tracks: 20, stops: 200, title: 200, text: 4000, bytes: 1 << 20 };
const SECONDS = [0, 600];
/** Numbers of a view, as the parameters of an address have them. */
const VIEW = { azimuth: [-360, 360], elevation: [-90, 90], fov: [1, 170], zoom: [0.05, 50] };

/**
 * @typedef {object} NoteView  azimuth, elevation, fov, zoom, target: all may be left out
 * @typedef {{at: number[], title: string, text: string, view: NoteView|null}} Annotation
 * @typedef {{name: string, loop: boolean, stops: {view: NoteView, seconds: number, pause: number, annotation: number|null}[]}} Track
 */

/**
 * @param {unknown} root  of JSON
 * @returns {{annotations: Annotation[], tracks: Track[]}}
 * @throws {ViewerError} 'damaged', whose detail names the place: "annotations[2].at"
 */
export function readNotes(root) {
  const from = object(root, 'the file');
  if (own(from, 'version') !== 1) refuse('version', 'is not 1');
  const annotations = list(own(from, 'annotations') ?? [], 'annotations', MOST.annotations).map(annotation);
  const tracks = list(own(from, 'tracks') ?? [], 'tracks', MOST.tracks).map((each, i) => track(each, `tracks[${i}]`, annotations.length));
  return { annotations, tracks };
}

/** Fetches, parses and checks. @throws {ViewerError} 'network', 'damaged' */
export async function fetchNotes(address) {
  const response = await fetch(address).catch(() => null);
  if (!response?.ok) throw new ViewerError('network', 'The notes cannot be fetched.', String(address));
  return parseNotes(await response.text());
}

/** Of a JSON's text. @throws {ViewerError} 'damaged' */
export function parseNotes(text) {
  if (text.length > MOST.bytes) refuse('the file', `is longer than ${MOST.bytes} bytes`);
  let root;
  try {
    root = JSON.parse(text);
  } catch (error) {
    refuse('the file', `is no JSON: ${error.message}`);
  }
  return readNotes(root);
}

function annotation(given, i) {
  const place = `annotations[${i}]`,
    from = object(given, place);
  return {
    at: triple(own(from, 'at'), `${place}.at`),
    title: text(own(from, 'title'), `${place}.title`, MOST.title),
    text: text(own(from, 'text') ?? '', `${place}.text`, MOST.text),
    view: (own(from, 'view') ?? null) === null ? null : view(own(from, 'view'), `${place}.view`),
  };
}

function track(given, place, annotations) {
  const from = object(given, place),
    loop = own(from, 'loop') ?? false;
  if (typeof loop !== 'boolean') refuse(`${place}.loop`, 'is neither true nor false');
  const stops = list(own(from, 'stops'), `${place}.stops`, MOST.stops).map((each, i) => stop(each, `${place}.stops[${i}]`, annotations));
  if (stops.length === 0) refuse(`${place}.stops`, 'is empty');
  return { name: text(own(from, 'name'), `${place}.name`, MOST.title), loop, stops };
}

function stop(given, place, annotations) {
  const from = object(given, place),
    shown = own(from, 'annotation') ?? null;
  if (shown !== null && !(Number.isInteger(shown) && shown >= 0 && shown < annotations))
    refuse(`${place}.annotation`, 'is no number of an annotation');
  return {
    view: view(own(from, 'view'), `${place}.view`),
    seconds: number(own(from, 'seconds') ?? 2, `${place}.seconds`, ...SECONDS),
    pause: number(own(from, 'pause') ?? 1, `${place}.pause`, ...SECONDS),
    annotation: shown,
  };
}

function view(given, place) {
  const from = object(given, place),
    out = {};
  for (const [name, [low, high]] of Object.entries(VIEW))
    if (own(from, name) !== undefined) out[name] = number(own(from, name), `${place}.${name}`, low, high);
  if (own(from, 'target') !== undefined) out.target = triple(own(from, 'target'), `${place}.target`);
  return out;
}

const own = (from, name) => (Object.hasOwn(from, name) ? from[name] : undefined);

function refuse(place, what) {
  throw new ViewerError('damaged', 'The notes cannot be read.', `${place} ${what}`);
}

function object(given, place) {
  if (typeof given !== 'object' || given === null || Array.isArray(given)) refuse(place, 'is no object');
  return given;
}

function list(given, place, most) {
  if (!Array.isArray(given)) refuse(place, 'is no list');
  if (given.length > most) refuse(place, `has more than ${most} entries`);
  return given;
}

function text(given, place, most) {
  if (typeof given !== 'string') refuse(place, 'is no text');
  if (given.length > most) refuse(place, `is longer than ${most} characters`);
  return given;
}

function number(given, place, low, high) {
  if (typeof given !== 'number' || !(given >= low && given <= high)) refuse(place, `is no number from ${low} to ${high}`);
  return given;
}

function triple(given, place) {
  if (!Array.isArray(given) || given.length !== 3 || !given.every((x) => Number.isFinite(x))) refuse(place, 'is not three numbers');
  return [...given];
}
