// SPDX-License-Identifier: Apache-2.0
// What viewer.html runs.
import { Elements } from './elements.js';
import { Viewer } from './viewer.js';
import { wordsOf } from './words.js';

const wanted = new URLSearchParams(location.search).get('lang');
const words = await wordsOf([wanted, ...navigator.languages].filter(Boolean));
window.viewer = new Viewer({}, { elements: new Elements(document, document.body, words) });
if (new URLSearchParams(location.search).has('edit')) {
  const { NoteEditor } = await import('./note_editor.js');
  window.noteEditor = new NoteEditor(window.viewer);
}
